// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/geometry/mesh.h"
#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

/// What a surface tells of a super-point, or of several together: sums over its vertices. World
/// frame, metres; colours from 0 to 255.
struct SuperPointShape {
  std::int64_t vertices = 0;
  Eigen::Vector3d position_sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d color_sum = Eigen::Vector3d::Zero();
  Eigen::AlignedBox3f box;

  SuperPointShape& operator+=(const SuperPointShape& other);
};

/// Where two super-points touch: sums over the edges of the mesh that lead from one to the other.
struct SuperPointBorder {
  std::int64_t edges = 0;
  double fold = 0;        ///< change of the normal along the edge; positive where it is convex
  double color_step = 0;  ///< difference of colour, summed over red, green and blue

  SuperPointBorder& operator+=(const SuperPointBorder& other);
};

/// The shapes of all super-points and the borders between them.
struct SuperPointShapes {
  std::map<Label, SuperPointShape> of;
  std::map<std::pair<Label, Label>, SuperPointBorder> borders;  ///< the lower label first

  /// Adds a piece of surface whose labels are super-points' roots.
  void add(const Mesh& patch);
};

/// Of the whole map, piece by piece: all of its surface is never in memory at once.
SuperPointShapes measure_super_points(const VoxelMap& map);

}  // namespace ovimap
