// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

/// Points of a surface: voxels or vertices. World frame, metres.
struct SurfaceExtent {
  std::size_t points = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::AlignedBox3f box;

  void add(const Eigen::Vector3f& point);
  SurfaceExtent& operator+=(const SurfaceExtent& other);
};
using SurfaceExtents = std::map<Label, SurfaceExtent>;  ///< of super-points, by root

/// Measures the surface voxels of the whole map, tile after tile.
SurfaceExtents surface_extents(const VoxelMap& map);

}  // namespace ovimap
