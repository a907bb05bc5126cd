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
          if (in_view({x, y, z}, region_m)) regions.emplace_back().key = pack_index({x, y, z});
    return regions;
  }

  void look(RegionLook& region) const {
    const BlockIndex first = unpack_index(region.key) * kRegionBlocks;
    for (int z = 0; z < kRegionBlocks; ++z)
      for (int y = 0; y < kRegionBlocks; ++y)
        for (int x = 0; x < kRegionBlocks; ++x) {
          const BlockIndex cell = first + BlockIndex(x, y, z);
          if (!tiles_.all_free(middle(cell, cell_m_), radius_m_)) continue;
          region.through[BlockRegion::position(cell)] = region.any = true;
        }
  }

 private:
  Eigen::Vector3f middle(const BlockIndex& index, double size_m) const {
    return (camera_from_world_ *
            Eigen::Vector3d((index.cast<double>() + Eigen::Vector3d::Constant(0.5)) * size_m))
        .cast<float>();
  }
  bool in_view(const BlockIndex& region, double region_m) const {
    return tiles_.any_free(middle(region, region_m), radius_m_ * kRegionBlocks);
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
