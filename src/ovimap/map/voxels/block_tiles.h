// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

/// A tile is a cube of 4 x 4 x 4 blocks, the unit in which voxels are stored and leave memory:
/// large enough for the entropy coder, small enough to be written alone.
inline constexpr int kTileSide = 4;

struct Tile {
  std::uint64_t key = 0;  ///< pack_index of the tile, that is of its block indices / 4 rounded down
  std::uint64_t present =
      0;  ///< bit x + 4 * (y + 4 * z): the block at that place of the tile exists
  std::vector<std::uint32_t> slots;  ///< of the blocks, in the order of their bits
};

/// All tiles with blocks, ascending by key.
std::vector<Tile> tiles_of(const VoxelMap& map);

/// Key of the tile that a block belongs to.
std::uint64_t tile_key(const BlockIndex& block);
/// The tile of that key as the map has it now.
Tile tile_at(const VoxelMap& map, std::uint64_t key);
/// The same with the blocks of `present` alone, all of which must exist.
Tile tile_at(const VoxelMap& map, std::uint64_t key, std::uint64_t present);
std::vector<const VoxelBlock*> blocks_of(const VoxelMap& map, const Tile& tile);

/// Whether blocks of such a tile have indices that can be packed.
bool valid_tile_key(std::uint64_t key);

/// Creates the blocks of a tile, empty.
Tile create_tile(VoxelMap& map, std::uint64_t key, std::uint64_t present);
/// Creates them as blocks that are not in memory (VoxelMap::create_away).
void create_tile_away(VoxelMap& map, std::uint64_t key, std::uint64_t present);

/// Calls `visit(tiles)` for one part of the map's tiles after another, ascending by key, and lets
/// the map make room in between: how to walk over a map that may be larger than memory. No block
/// may be referred to from one call to the next.
template <class Visit>
void for_each_part(const VoxelMap& map, Visit&& visit) {
  constexpr std::size_t kTilesPerPart = 64;
  const std::vector<Tile> tiles = tiles_of(map);
  for (std::span<const Tile> left(tiles); !left.empty();
       left = left.subspan(std::min(kTilesPerPart, left.size()))) {
    visit(left.first(std::min(kTilesPerPart, left.size())));
    map.trim();
  }
}

}  // namespace ovimap
