// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

/// Calls `visit(region)` for all regions of the map that may show in a view up to `far_m` along its
/// axis, and for some around it. In a map of many these are looked up one by one, so that a frame
/// costs what it shows, however large the map has become.
template <class Visit>
void for_each_region_in_view(const VoxelMap& map, const PinholeCamera& camera,
                             const Pose& world_from_camera, float far_m, const Visit& visit) {
  constexpr double kBlocksOfRegion = 60;  // that surface fills, about
  const double region_m = map.config().block_size_m() * kRegionBlocks;
  Eigen::AlignedBox3d view(world_from_camera.translation());
  for (const float u : {-1.f, static_cast<float>(camera.width)})
    for (const float v : {-1.f, static_cast<float>(camera.height)})
      view.extend(world_from_camera * camera.unproject(u, v, far_m).cast<double>());
  // The spheres around regions that callers hold against the view reach out of it.
  const double margin = 2 * double{kCubeHalfDiagonal} + 1;
  const Eigen::Array3d low = (view.min() / region_m).array().floor() - margin,
                       high = (view.max() / region_m).array().floor() + margin;
  const double blocks = (high - low + 1).prod() * kBlocksOfRegion;
  if (!(blocks < static_cast<double>(map.block_count()))) return map.for_each_region(visit);
  const BlockIndex first = low.floor().cast<int>(), last = high.ceil().cast<int>();
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x)
        if (const BlockRegion* region = map.find_region({x, y, z})) visit(*region);
}

}  // namespace ovimap
