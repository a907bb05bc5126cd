// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ovimap/image/image.h"
#include "ovimap/synth/render/renderer.h"
#include "ovimap/synth/render/surface_tracer.h"

namespace ovimap {

using LightImage = Image<Eigen::Vector3f>;  ///< linear RGB light falling on each pixel's surface

/// Light on the surfaces of one image. Each pixel of a 4x4 block tests other points of the lamps
/// and other directions; the blocks are then averaged over neighbours on the same plane
/// (interleaved sampling: Keller and Heidrich, 2001), which gives soft shadows for few rays.
class Lighting {
 public:
  Lighting(const SynthRoom& room, const RayScene& scene, const RenderConfig& config);

  LightImage gather(const Image<SurfacePoint>& surfaces) const;

 private:
  Eigen::Vector3f light_at(const SurfacePoint& point, int pattern) const;
  bool faint(const AreaLight& lamp, const SurfacePoint& point) const;
  Eigen::Vector3f lamp_light(const AreaLight& lamp, const SurfacePoint& point, int pattern) const;
  Eigen::Vector3f ambient_light(const SurfacePoint& point, int pattern) const;

  const SynthRoom& room_;
  const RayScene& scene_;
  RenderConfig config_;
  std::vector<Eigen::Vector2f> lamp_samples_;     ///< -1..1 squared, 16 patterns one after another
  std::vector<Eigen::Vector3f> ambient_samples_;  ///< about +z, cosine-weighted, likewise
};

}  // namespace ovimap
