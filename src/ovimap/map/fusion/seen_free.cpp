// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/fusion/seen_free.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ovimap/base/parallel.h"
#include "ovimap/map/fusion/free_tiles.h"

namespace ovimap {

namespace {

constexpr std::size_t kRegionsPerTask = 4;

/// The cells of one region that a frame looks through.
struct RegionLook {
  std::uint64_t key = 0;
  std::array<bool, kRegionBlocks * kRegionBlocks * kRegionBlocks> through{};
  bool any = false;
};

class Looker {
 public:
  Looker(const PinholeCamera& camera, const Pose& world_from_camera, const Image<float>& free_m,
         float cell_m)
      : camera_from_world_(world_from_camera.inverse()),
        tiles_(camera, free_m),
        cell_m_(static_cast<double>(cell_m)),
        radius_m_(cell_m * kCubeHalfDiagonal) {}

  /// Regions that the view reaches, in no particular order.
  std::vector<RegionLook> regions() const {
    const double region_m = cell_m_ * kRegionBlocks;
    const Eigen::AlignedBox3d reach = tiles_.reach(camera_from_world_.inverse());
    const Eigen::Vector3i low = (reach.min() / region_m).array().floor().cast<int>(),
                          high = (reach.max() / region_m).array().floor().cast<int>();
    std::vector<RegionLook> regions;
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x)
          if (in_view({x, y, z})) regions.emplace_back().key = pack_index({x, y, z});
    return regions;
  }

  void look(RegionLook& region) const {
    look(unpack_index(region.key) * kRegionBlocks, kRegionBlocks, region);
  }

 private:
  /// A cube of so many cells along a side, `first` the lowest of them: it is cut in eight where it
  /// is neither free nor hidden as a whole.
  void look(const BlockIndex& first, int side, RegionLook& region) const {
    const Eigen::Vector3f center = middle_of_cube(first, side);
    const float radius_m = radius_m_ * static_cast<float>(side);
    if (tiles_.none_free(center, radius_m)) return;
    if (tiles_.all_free(center, radius_m)) return mark(first, side, region);
    if (side == 1) return;
    for (int part = 0; part < 8; ++part)
      look(first + BlockIndex(part & 1, part >> 1 & 1, part >> 2) * (side / 2), side / 2, region);
  }
  static void mark(const BlockIndex& first, int side, RegionLook& region) {
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
          region.through[BlockRegion::position(first + BlockIndex(x, y, z))] = true;
    region.any = true;
  }
  Eigen::Vector3f middle_of_cube(const BlockIndex& first, int side) const {
    const Eigen::Vector3d middle =
        (first.cast<double>() + Eigen::Vector3d::Constant(0.5 * side)) * cell_m_;
    return (camera_from_world_ * middle).cast<float>();
  }
  bool in_view(const BlockIndex& region) const {
    return tiles_.any_free(middle_of_cube(region * kRegionBlocks, kRegionBlocks),
                           radius_m_ * kRegionBlocks);
  }

  Pose camera_from_world_;
  LeastTiles tiles_;
  double cell_m_;
  float radius_m_;
};

}  // namespace

void SeenFree::look(const PinholeCamera& camera, const Pose& world_from_camera,
                    const Image<float>& free_m, float cell_m) {
  const Looker looker(camera, world_from_camera, free_m, cell_m);
  std::vector<RegionLook> looks = looker.regions();
  parallel_for(looks.size(), kRegionsPerTask, [&](std::size_t i) { looker.look(looks[i]); });
  for (const RegionLook& look : looks) {
    if (!look.any) continue;
    SpaceRegion& region = regions_[look.key];
    for (std::size_t i = 0; i < region.size(); ++i) {
      if (!look.through[i]) continue;
      region[i].looks =
          static_cast<std::uint8_t>(std::min<int>(region[i].looks + 1, SpaceCell::kMost));
      region[i].taken = 0;
    }
  }
}

SpaceCell SeenFree::at(const BlockIndex& cell) const {
  const auto found = regions_.find(pack_index(BlockRegion::index_of(cell)));
  return found == regions_.end() ? SpaceCell{} : found->second[BlockRegion::position(cell)];
}

void SeenFree::take(std::span<const BlockIndex> cells, int ticks, int stays) {
  for (const BlockIndex& index : cells) {
    const auto found = regions_.find(pack_index(BlockRegion::index_of(index)));
    if (found == regions_.end()) continue;
    SpaceCell& cell = found->second[BlockRegion::position(index)];
    if (cell.looks == 0) continue;
    const int taken = cell.taken + ticks;
    cell = taken >= std::min<int>(stays, SpaceCell::kMost)
               ? SpaceCell{}
               : SpaceCell{cell.looks, static_cast<std::uint8_t>(taken)};
  }
}

void SeenFree::stand(std::span<const BlockIndex> cells, int ticks, int known) {
  for (const BlockIndex& index : cells) {
    SpaceCell& cell = cell_at(index);
    const int taken = std::min<int>(cell.taken + ticks, SpaceCell::kMost);
    cell.taken = static_cast<std::uint8_t>(taken);
    if (taken >= known) cell.suspect = false;
  }
}

void SeenFree::suspect(const BlockIndex& cell) {
  cell_at(cell).suspect = true;
}

std::vector<BlockIndex> SeenFree::suspects() const {
  std::vector<BlockIndex> cells;
  for (const auto& [key, region] : regions_)
    for (std::size_t i = 0; i < region.size(); ++i)
      if (region[i].suspect) cells.push_back(BlockRegion::block_at(unpack_index(key), i));
  return cells;
}

SpaceCell& SeenFree::cell_at(const BlockIndex& index) {
  return regions_[pack_index(BlockRegion::index_of(index))][BlockRegion::position(index)];
}

}  // namespace ovimap
