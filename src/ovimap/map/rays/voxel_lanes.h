// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstring>

#include "ovimap/base/lanes.h"
#include "ovimap/map/rays/surface_lookup.h"

namespace ovimap {

/// Looks up eight voxels at once, as VoxelFinder does one, for rays through pixels that are
/// neighbours: mostly they are in one region. One per thread; in OVIMAP_VECTORIZE functions.
class VoxelLanes {
 public:
  explicit VoxelLanes(const VoxelMap& map)
      : map_(map),
        finder_(map),
        metres_per_unit_(map.config().truncation_m() / VoxelBlock::kTsdfScale) {}

  /// Global voxel coordinates.
  struct Coordinates {
    Ints x, y, z;
  };
  struct Voxels {
    Ints slot;        ///< of the block; -1 where the map has none, and in lanes not asked for
    Ints offset;      ///< in the block
    Ints empty_bits;  ///< where there is no block: of as many voxels (log2) a side is what is empty
    const VoxelBlock* block = nullptr;  ///< if all lanes are in one that there is
  };

  OVIMAP_INLINE Voxels seek(const Coordinates& at, Ints wanted) {
    const Coordinates region{at.x >> kRegionBits, at.y >> kRegionBits, at.z >> kRegionBits};
    const Ints position =  // of BlockRegion
        (at.x >> 3 & 7) | (at.y >> 3 & 7) << 3 | (at.z >> 3 & 7) << 6;
    Voxels result{Ints{} - 1, (at.x & 7) | (at.y & 7) << 3 | (at.z & 7) << 6, Ints{} + kRegionBits};
    const Ints elsewhere = (region.x != region_index_.x()) | (region.y != region_index_.y()) |
                           (region.z != region_index_.z());
    if (any(wanted & elsewhere)) [[unlikely]] {
      seek_apart(region, position, wanted, result);
      return result;
    }
    if (!region_) return result;
    if (any(position != position[0])) {
      result.slot = ~wanted | ints_by_lane([&](int lane) __attribute__((always_inline)) {
        return slot_at(position[lane]);
      });
      if (any(result.slot < 0))
        result.empty_bits = ints_by_lane([&](int lane) __attribute__((always_inline)) {
          return empty_bits_at(position[lane]);
        });
    } else if (const std::int32_t slot = slot_at(position[0]); slot >= 0) {
      result.slot = ~wanted | slot;
      result.block = &map_.block(static_cast<std::uint32_t>(slot));
    } else {
      result.empty_bits = Ints{} + empty_bits_at(position[0]);
    }
    return result;
  }

  /// Signed distances; 0 where there is no block or a voxel was never observed.
  struct Distances {
    Floats metres;
    Ints observed;  ///< mask
  };
  OVIMAP_INLINE Distances distances(const Voxels& voxels) const {
    const Ints stored = stored_distances(voxels);
    return {__builtin_convertvector(stored, Floats) * metres_per_unit_, stored != 0};
  }
  float metres_per_unit() const { return metres_per_unit_; }

  /// Signed distances of a cube of two voxels a side, stored units: `at[i]` of the voxel at offset
  /// (i & 1, i >> 1 & 1, i >> 2). False in lanes where one of the eight was never observed.
  OVIMAP_INLINE Ints read_cells(const Coordinates& low, Ints wanted, Floats* at) {
    const Voxels voxels = seek(low, wanted);
    const Ints within = ((low.x & 7) < 7) & ((low.y & 7) < 7) & ((low.z & 7) < 7);
    const Ints known = voxels.slot >= 0;
    VoxelBlock::Tsdf apart[kLanes][kCellSpan];
    const VoxelBlock::Tsdf* rows[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) {
      rows[lane] = apart[lane];
      if (!known[lane])
        rows[lane] = kNothing.data();
      else if (within[lane])
        rows[lane] = block(voxels.slot[lane]).tsdf.data() + voxels.offset[lane];
      else
        copy_cell({low.x[lane], low.y[lane], low.z[lane]}, apart[lane]);
    }
    Ints zero = {};
    for (int pair = 0; pair < 4; ++pair) {
      const int offset = voxel_offset(0, pair & 1, pair >> 1);
      const Ints words = ints_by_lane([&](int lane) __attribute__((always_inline)) {
        std::int32_t word;
        std::memcpy(&word, rows[lane] + offset, sizeof(word));
        return word;
      });
      const Ints first = words << 16 >> 16, second = words >> 16;
      zero |= (first == 0) | (second == 0);
      at[2 * pair] = __builtin_convertvector(first, Floats);
      at[2 * pair + 1] = __builtin_convertvector(second, Floats);
    }
    return known & ~zero;
  }

 private:
  static constexpr int kBlockBits = 3, kRegionBits = 6;
  static constexpr int kCellSpan = 1 + 1 + kBlockSide + kBlockSide * kBlockSide;
  /// Distances of blocks that the map does not have.
  static constexpr std::array<VoxelBlock::Tsdf, kBlockVoxels> kNothing = {};

  const VoxelBlock& block(std::int32_t slot) const {
    return map_.block(static_cast<std::uint32_t>(slot));
  }
  std::int32_t empty_bits_at(std::int32_t position) const {
    return (region_->groups >> BlockRegion::group(position) & 1) != 0 ? kBlockBits : kBlockBits + 1;
  }
  std::int32_t slot_at(std::int32_t position) const {
    return static_cast<std::int32_t>(region_->slots[static_cast<std::size_t>(position)]);
  }

  OVIMAP_INLINE Ints stored_distances(const Voxels& voxels) const {
    if (const VoxelBlock* const block = voxels.block)
      return ints_by_lane([&](int lane) __attribute__((always_inline)) {
        return block->tsdf[static_cast<std::size_t>(voxels.offset[lane])];
      });
    const VoxelBlock::Tsdf* distances[kLanes];
    for (int lane = 0; lane < kLanes; ++lane)
      distances[lane] =
          voxels.slot[lane] < 0 ? kNothing.data() : block(voxels.slot[lane]).tsdf.data();
    return ints_by_lane([&](int lane) __attribute__((always_inline)) {
      return distances[lane][voxels.offset[lane]];
    });
  }

  /// For lanes in several regions.
  void seek_apart(const Coordinates& region, Ints position, Ints wanted, Voxels& result) {
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!wanted[lane]) continue;
      seek_region({region.x[lane], region.y[lane], region.z[lane]});
      if (!region_) continue;
      result.slot[lane] = slot_at(position[lane]);
      result.empty_bits[lane] = empty_bits_at(position[lane]);
    }
  }
  void seek_region(const BlockIndex& index) {
    if (index == region_index_) return;
    region_index_ = index;
    region_ = map_.find_region(index);
  }

  /// The eight voxels of a cell that lies in several blocks, laid out as in one block; 0 where
  /// there is none.
  void copy_cell(const Eigen::Vector3i& low, VoxelBlock::Tsdf* cell) {
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3i offset(corner & 1, corner >> 1 & 1, corner >> 2);
      const bool found = finder_.seek(Eigen::Vector3i(low + offset));
      cell[voxel_offset(offset.x(), offset.y(), offset.z())] =
          found ? finder_.block().tsdf[static_cast<std::size_t>(finder_.voxel())]
                : VoxelBlock::Tsdf{0};
    }
  }

  const VoxelMap& map_;
  VoxelFinder finder_;
  float metres_per_unit_;                                    ///< of a stored distance
  BlockIndex region_index_ = BlockIndex::Constant(1 << 24);  // outside every map
  const BlockRegion* region_ = nullptr;
};

}  // namespace ovimap
