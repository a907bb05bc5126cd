// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "ovimap/map/voxel_map.h"

namespace ovimap {

/// One block's voxels and the first layer of its seven upper neighbours, as bits: what marching
/// cubes asks of every cell, eight cells of a row at a time.
class CellRows {
 public:
  static constexpr int kSide = kBlockSide + 1;  ///< a block's cells reach one voxel further

  CellRows(const VoxelMap& map, std::uint32_t slot);

  /// The cells of row (y, z), bit x, whose eight corners are observed and lie on both sides of the
  /// surface.
  unsigned surface_cells(int y, int z) const;

  /// Which corners of a cell lie inside: bit i is the corner (i & 1, i >> 1 & 1, i >> 2 & 1).
  unsigned inside_corners(int x, int y, int z) const;

  /// The block of a voxel, each coordinate in [0, 8]; not null for the corners of surface cells.
  const VoxelBlock* block(int x, int y, int z) const {
    return blocks_[static_cast<std::size_t>(x >> 3 | (y >> 3) << 1 | (z >> 3) << 2)];
  }

 private:
  struct Row {
    std::uint16_t observed = 0, inside = 0;  ///< bit x, in [0, 8]
  };
  const Row& row(int y, int z) const { return rows_[static_cast<std::size_t>(y + kSide * z)]; }
  Row read(int y, int z, float min_weight) const;

  std::array<const VoxelBlock*, 8> blocks_;
  std::array<Row, kSide * kSide> rows_;
};

}  // namespace ovimap
