// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/surface_extents.h"

#include <cmath>
#include <span>
#include <vector>

#include "ovimap/base/parallel.h"
#include "ovimap/map/voxels/block_tiles.h"
#include "ovimap/map/voxels/label_slots.h"

namespace ovimap {

namespace {

/// Adds the surface voxels of one block by label.
void add_extents(const VoxelMap& map, const VoxelBlock& block, SurfaceExtents& extents) {
  const float voxel_size = map.config().voxel_size_m;
  for (int v = 0; v < kBlockVoxels; ++v) {
    if (block.weight[static_cast<std::size_t>(v)] <= 0.f ||
        std::fabs(map.distance_m(block, v)) >= voxel_size)
      continue;
    const Label label = voxel_label(block, v, map.labels());
    if (label == kNoLabel) continue;
    const Eigen::Vector3i offset(v & 7, v >> 3 & 7, v >> 6);
    const Eigen::Vector3f center =
        ((block.index * kBlockSide + offset).cast<float>().array() + 0.5f) * voxel_size;
    extents[label].add(center);
  }
}

}  // namespace

void SurfaceExtent::add(const Eigen::Vector3f& point) {
  ++points;
  sum += point.cast<double>();
  box.extend(point);
}

SurfaceExtent& SurfaceExtent::operator+=(const SurfaceExtent& other) {
  points += other.points;
  sum += other.sum;
  box.extend(other.box);
  return *this;
}

SurfaceExtents surface_extents(const VoxelMap& map) {
  SurfaceExtents totals;
  for_each_part(map, [&](std::span<const Tile> tiles) {
    std::vector<SurfaceExtents> extents(tiles.size());
    parallel_for(tiles.size(), 2, [&](std::size_t i) {
      for (const std::uint32_t slot : tiles[i].slots) add_extents(map, map.block(slot), extents[i]);
    });
    for (const SurfaceExtents& of_tile : extents)
      for (const auto& [label, extent] : of_tile) totals[label] += extent;
  });
  return totals;
}

}  // namespace ovimap
