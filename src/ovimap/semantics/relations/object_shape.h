// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/semantics/relations/footprint.h"

namespace ovimap {

/// The ground frame: x and y in the horizontal plane, z up, the world's origin.
Eigen::Matrix3f ground_from_world(const Eigen::Vector3f& up_in_world);

/// An object as relations see it: an upright prism, and the surface in it where it is known. All
/// in the ground frame, metres.
struct ObjectShape {
  float bottom_m = 0, top_m = 0;
  Footprint footprint;
  Eigen::Vector3f centroid = Eigen::Vector3f::Zero();
  std::vector<Eigen::Vector3f> surface;  ///< may be empty: then the prism counts as solid
  // A floor has a hundred thousand points and is asked about by every object of a building.
  std::vector<Eigen::AlignedBox3f> runs;    ///< around each kPointsOfRun of the surface, in order
  std::vector<Eigen::AlignedBox3f> groups;  ///< around each kRunsOfGroup of these

  static constexpr std::size_t kPointsOfRun = 64, kRunsOfGroup = 32;
  /// The points in runs[run].
  std::span<const Eigen::Vector3f> run_points(std::size_t run) const;

  float height_m() const { return top_m - bottom_m; }
  float middle_m() const { return 0.5f * (top_m + bottom_m); }
};

/// From points of the object's surface in the world, without the 0.5 % at the top and at the bottom
/// that may be noise: the better way, since boxes along the axes of a tilted world are too large.
/// At least one point.
ObjectShape shape_of_points(const Eigen::Matrix3f& ground_from_world,
                            std::span<const Eigen::Vector3f> points_in_world);

/// From a box in the world and the object's centroid, which is all of it where the box is empty.
ObjectShape shape_of_box(const Eigen::Matrix3f& ground_from_world,
                         const Eigen::AlignedBox3f& box_in_world,
                         const Eigen::Vector3f& centroid_in_world);

/// What bounds the prism, ground frame.
Eigen::AlignedBox3f upright_box(const ObjectShape& shape);

/// Distance between the surfaces of two objects; 0 where they touch. Where a surface is known, the
/// gap to it counts, not that to the convex prism around it.
float gap_m(const ObjectShape& a, const ObjectShape& b);

/// Height of what the object `below` puts under `above`: its highest surface under the footprint,
/// widened by `margin_m`, and not higher than the middle of `above`. Lowest float when there is
/// none.
float support_height_m(const ObjectShape& above, const ObjectShape& below, float margin_m);

}  // namespace ovimap
