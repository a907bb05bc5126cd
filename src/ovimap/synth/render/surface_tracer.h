// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/synth/render/ray_scene.h"

namespace ovimap {

/// What one ray of a camera meets.
struct SurfacePoint {
  std::uint16_t id = 0;  ///< RoomObject::id; 0: the ray leaves the room, nothing else is set
  float depth = 0;       ///< along the optical axis, metres
  float incidence_cos = 0;
  Eigen::Vector3f position = Eigen::Vector3f::Zero();     ///< world frame
  Eigen::Vector3f face_normal = Eigen::Vector3f::Zero();  ///< of the triangle, towards the camera
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();       ///< interpolated, towards the camera
  Eigen::Vector3f albedo = Eigen::Vector3f::Zero();       ///< linear
  Eigen::Vector3f emission = Eigen::Vector3f::Zero();     ///< linear
};

/// Follows camera rays to surfaces and reads their material.
class SurfaceTracer {
 public:
  explicit SurfaceTracer(std::span<const RoomObject> objects);

  /// The surface at pixel coordinates (u, v), which need not be whole. Without `with_material` the
  /// interpolated normal, albedo and emission stay unset.
  SurfacePoint trace(const PinholeCamera& camera, const Pose& world_from_camera, double u, double v,
                     bool with_material) const;

  const RayScene& scene() const { return scene_; }

 private:
  void read_material(const RayHit& hit, float footprint_m, SurfacePoint& point) const;

  RayScene scene_;
  std::vector<std::vector<float>>
      texel_density_;  ///< texture pixels a metre, by object and triangle
};

}  // namespace ovimap
