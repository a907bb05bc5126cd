// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/motion/fresh_surface.h"

#include <algorithm>
#include <cmath>

#include "ovimap/map/rays/surface_lookup.h"
#include "ovimap/pipeline/motion/frame_points.h"

namespace ovimap {

namespace {

constexpr int kSampleStep_px = 4;

/// A cell and whether the map has surface there.
struct CellSeen {
  std::uint64_t key;
  bool known;
};

/// Each cell once, known where one of its pixels says so.
StandingCells joined(std::vector<CellSeen> seen) {
  std::sort(seen.begin(), seen.end(), [](const CellSeen& a, const CellSeen& b) {
    return a.key != b.key ? a.key < b.key : a.known > b.known;
  });
  StandingCells result;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (i > 0 && seen[i].key == seen[i - 1].key) continue;
    result.cells.push_back(unpack_index(seen[i].key));
    if (seen[i].known) result.known.push_back(result.cells.back());
  }
  return result;
}

/// Whether all pixels so far around move: none of them mixes two depths.
bool inside(const IdImage& moving, int x, int y, int around_px) {
  for (const int dy : {-around_px, 0, around_px})
    for (const int dx : {-around_px, 0, around_px})
      if (!moving.contains(x + dx, y + dy) || moving.at(x + dx, y + dy) == 0) return false;
  return true;
}

}  // namespace

StandingCells standing_cells(const VoxelMap& map, const SeenFree& space, const Observation& seen,
                             const IdImage& moving, const MotionConfig& config) {
  const FramePoints points(seen);
  const float inverse_cell = 1.f / map.config().block_size_m(),
              near_m = kOnSurface_voxels * map.config().voxel_size_m;
  SpaceFinder cells(space);
  VoxelFinder voxels(map);
  std::vector<CellSeen> found;
  for (int y = kSampleStep_px / 2; y < seen.depth.height(); y += kSampleStep_px)
    for (int x = kSampleStep_px / 2; x < seen.depth.width(); x += kSampleStep_px) {
      const float depth_m = seen.depth.at(x, y);
      if (depth_m <= 0.f || (!moving.empty() && moving.at(x, y) != 0)) continue;
      const Eigen::Vector3f point = points.at(x, y, depth_m);
      const BlockIndex index = block_at(point, inverse_cell);
      const SpaceCell cell = cells.at(index);
      if (cell.looks >= config.looks) continue;
      const bool known = cell.taken == 0 && voxels.seek(point) && voxels.observed() &&
                         std::fabs(voxels.distance_m()) < near_m;
      found.push_back({pack_index(index), known});
    }
  return joined(std::move(found));
}

std::vector<BlockIndex> fresh_cells(const SeenFree& space, const std::vector<MovingPatch>& patches,
                                    float cell_m, const MotionConfig& config) {
  SpaceFinder finder(space);
  std::vector<BlockIndex> fresh;
  for (const MovingPatch& patch : patches) {
    const BlockIndex low = block_at(patch.box.min().array() - config.beside_m, 1.f / cell_m),
                     high = block_at(patch.box.max().array() + config.beside_m, 1.f / cell_m);
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) {
          const SpaceCell cell = finder.at({x, y, z});
          if (cell.taken > 0 && is_fresh(cell, config)) fresh.emplace_back(x, y, z);
        }
  }
  return fresh;
}

Image<float> hasty_free_depth(const VoxelMapConfig& map, const Observation& seen,
                              const IdImage& moving, const FreeSpaceConfig& free_space,
                              const MotionConfig& config) {
  FreeSpaceConfig hasty = free_space;
  hasty.guard_px = config.back_guard_px;
  Image<float> free_m = free_depth(map, seen, hasty);
  const float behind_m = map.truncation_m();
  for (int y = 0; y < moving.height(); ++y)
    for (int x = 0; x < moving.width(); ++x)
      if (moving.at(x, y) != 0 && moving.at(x, y) != MovingPixels::kTakenOut &&
          inside(moving, x, y, config.edge_px))
        free_m.at(x, y) = std::max(free_m.at(x, y), seen.depth.at(x, y) + behind_m);
  return free_m;
}

}  // namespace ovimap
