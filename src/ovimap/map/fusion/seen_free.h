// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "ovimap/map/fusion/integrate.h"

namespace ovimap {

/// What is known of a cell of space, as large as a block of voxels.
struct SpaceCell {
  std::uint8_t looks = 0;  ///< how often all of it was looked through; no more than kMost
  std::uint8_t taken = 0;  ///< for how long surface is seen in it since then, in ticks
  bool suspect = false;  ///< surface was seen in it for the first time beside something that moved

  static constexpr std::uint8_t kMost = 255;
  bool operator==(const SpaceCell&) const = default;
};

/// The cells of a cube of 8 x 8 x 8 blocks, by BlockRegion::position.
using SpaceRegion = std::array<SpaceCell, kRegionBlocks * kRegionBlocks * kRegionBlocks>;

/// Space that frames looked through. The map has voxels near surfaces alone and cannot tell empty
/// space from space that nobody saw; this is three bytes for every block of the space in view,
/// a hundredth of what the surface of the same room takes, so it stays in memory whatever the
/// bound. Surface in space that was seen empty has come there since (as in Dynablox, Schmid et al.,
/// RA-L 2023, by blocks and not by voxels).
class SeenFree {
 public:
  using Regions = std::map<std::uint64_t, SpaceRegion>;  ///< by pack_index, so in a fixed order

  /// One more look through every cell of which all rays run through it, before `free_m`
  /// (free_depth): the whole of it, what lies in the same tiles of the image included. What is seen
  /// through is taken by nothing. `cell_m`: VoxelMapConfig::block_size_m, the same in every call.
  void look(const PinholeCamera& camera, const Pose& world_from_camera, const Image<float>& free_m,
            float cell_m);

  /// Zeros for a cell that was never looked through.
  SpaceCell at(const BlockIndex& cell) const;
  /// Surface stood in these cells for `ticks` more; where that makes `stays` the cell is as never
  /// looked through. Cells that were not looked through are left alone.
  void take(std::span<const BlockIndex> cells, int ticks, int stays);
  /// Surface that nothing contradicts is seen in these cells for `ticks` more; what is seen for
  /// `known` is no suspect.
  void stand(std::span<const BlockIndex> cells, int ticks, int known);
  /// The surface in a cell is to go as soon as a frame sees through it.
  void suspect(const BlockIndex& cell);
  /// All of which that was said and not taken back by `stand`.
  std::vector<BlockIndex> suspects() const;

  const Regions& regions() const { return regions_; }
  void restore(Regions regions) { regions_ = std::move(regions); }
  void clear() { regions_.clear(); }

 private:
  SpaceCell& cell_at(const BlockIndex& index);

  Regions regions_;
};

/// Looks cells up, remembering the last region. One per thread.
class SpaceFinder {
 public:
  explicit SpaceFinder(const SeenFree& space) : regions_(space.regions()) {}

  SpaceCell at(const BlockIndex& cell) {
    const BlockIndex region = BlockRegion::index_of(cell);
    if (region != index_) {
      index_ = region;
      const auto found = regions_.find(pack_index(region));
      region_ = found == regions_.end() ? nullptr : &found->second;
    }
    return region_ ? (*region_)[BlockRegion::position(cell)] : SpaceCell{};
  }

 private:
  const SeenFree::Regions& regions_;
  BlockIndex index_ = BlockIndex::Constant(1 << 24);  // outside every map
  const SpaceRegion* region_ = nullptr;
};

}  // namespace ovimap
