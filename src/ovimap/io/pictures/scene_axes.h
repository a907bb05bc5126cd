// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "ovimap/geometry/mesh.h"
#include "ovimap/geometry/pose.h"

namespace ovimap {

class ConfigFields;

struct SceneAxesConfig {
  float cone_deg = 50.f;   ///< the floor's normal is at most this far from the cameras' mean up
  float window_deg = 8.f;  ///< normals this near to each other belong to one direction
};
void list_fields(SceneAxesConfig& config, ConfigFields& fields);

/// Which way the surface of a mesh that comes in parts faces: area by direction, in steps of about
/// a degree, so that it takes the same memory however large the mesh is.
class SurfaceDirections {
 public:
  SurfaceDirections();
  void add(const Mesh& part);
  /// Sums of normals times twice the area; zero where no surface faces that way.
  const std::vector<Eigen::Vector3f>& area_normals();

 private:
  std::vector<Eigen::Vector3d> sums_;
  std::vector<Eigen::Vector3f> normals_;
};

/// Which way is up in a world that may have any axis up: the direction, near the cameras' mean up
/// (their -y), in which most surface faces - floors and table tops. The cameras' mean up itself
/// where no surface faces that way, and +z without cameras. Unit length, world frame.
Eigen::Vector3f guess_up(const Mesh& mesh, std::span<const Pose> world_from_camera,
                         const SceneAxesConfig& config = {});
Eigen::Vector3f guess_up(SurfaceDirections& directions, std::span<const Pose> world_from_camera,
                         const SceneAxesConfig& config = {});

/// A horizontal direction along most walls: the commonest normal of upright
/// surface, by area and modulo 90 degrees. Of the four, the one next to a fixed axis of the world,
/// so that maps of one place are drawn alike. Some horizontal direction where there are no walls.
/// Unit length.
Eigen::Vector3f guess_wall_direction(SurfaceDirections& directions, const Eigen::Vector3f& up);

}  // namespace ovimap
