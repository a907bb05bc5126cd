// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/geometry/view_bounds.h"
#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

/// Calls `visit(region)` for all regions of the map of which a block may show in a view up to
/// `far_m` along its axis, and for some around it. In a map of many these are looked up one by one,
/// so that a frame costs what it shows, however large the map has become.
template <class Visit>
void for_each_region_in_view(const VoxelMap& map, const PinholeCamera& camera,
                             const Pose& world_from_camera, float far_m, const Visit& visit) {
  constexpr double kBlocksOfRegion = 60;  // that surface fills, about
  constexpr double kMargin = 1;  // blocks beside the view lie in its regions or the next ones
  const double region_m = map.config().block_size_m() * kRegionBlocks;
  const Eigen::AlignedBox3d view = box_of_view(camera, world_from_camera, far_m);
  const Eigen::Array3d low = (view.min() / region_m).array().floor() - kMargin,
                       high = (view.max() / region_m).array().floor() + kMargin;
  const double blocks = (high - low + 1).prod() * kBlocksOfRegion;
  if (!(blocks < static_cast<double>(map.block_count()))) return map.for_each_region(visit);
  const BlockIndex first = low.cast<int>(), last = high.cast<int>();
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x)
        if (const BlockRegion* region = map.find_region({x, y, z})) visit(*region);
}

}  // namespace ovimap
