// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

/// One block's voxels and the first layer of its seven upper neighbours, as bits: what marching
/// cubes asks of every cell, eight cells of a row at a time.
class CellRows {
 public:
  static constexpr int kSide = kBlockSide + 1;  ///< a block's cells reach one voxel further

  CellRows(const VoxelMap& map, std::uint32_t slot);

  /// The cells of row (y, z), bit x, whose eight corners are observed and lie on both sides of the
  /// surface.
  unsigned surface_cells(int y, int z);

  /// Which corners of a cell lie inside: bit i is the corner (i & 1, i >> 1 & 1, i >> 2 & 1).
  unsigned inside_corners(int x, int y, int z) const;

  /// The block of a voxel, each coordinate in [0, 8]; not null for the corners of surface cells.
  const VoxelBlock* block(int x, int y, int z) const {
    return blocks_[static_cast<std::size_t>(x >> 3 | (y >> 3) << 1 | (z >> 3) << 2)];
  }

 private:
  static constexpr std::uint16_t kUnread = 0xffff;
  static std::size_t at(int y, int z) { return static_cast<std::size_t>(y + kSide * z); }
  std::uint16_t read_inside(int y, int z) const;
  std::uint16_t read_observed(int y, int z) const;
  unsigned observed(int y, int z) {
    std::uint16_t& row = observed_[at(y, z)];
    if (row == kUnread) row = read_observed(y, z);
    return row;
  }

  float min_weight_;
  std::array<const VoxelBlock*, 8> blocks_;
  // By row (y, z), bit x in [0, 8]. Weights are read only where the sign of the distance changes:
  // most blocks of the band around a surface hold none of it.
  std::array<std::uint16_t, kSide * kSide> inside_, observed_;
};

}  // namespace ovimap
