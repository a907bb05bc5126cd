// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/voxels/block_tiles.h"

#include <algorithm>
#include <bit>

namespace ovimap {

namespace {

constexpr int kTileBlocks = kTileSide * kTileSide * kTileSide;

BlockIndex tile_of(const BlockIndex& block) {
  constexpr int kShift = std::bit_width(static_cast<unsigned>(kTileSide)) - 1;
  return {block.x() >> kShift, block.y() >> kShift, block.z() >> kShift};  // floor for either sign
}

int bit_of(const BlockIndex& place) {
  return place.x() + kTileSide * (place.y() + kTileSide * place.z());
}

/// The way back from bit_of.
BlockIndex block_in_tile(std::uint64_t key, int bit) {
  const BlockIndex place(bit % kTileSide, bit / kTileSide % kTileSide,
                         bit / (kTileSide * kTileSide));
  return unpack_index(key) * kTileSide + place;
}

}  // namespace

std::vector<Tile> tiles_of(const VoxelMap& map) {
  struct Entry {
    std::uint64_t key;
    int bit;
    std::uint32_t slot;
  };
  std::vector<Entry> entries(map.block_count());
  for (std::uint32_t slot = 0; slot < entries.size(); ++slot) {
    const BlockIndex& index = map.block_index(slot);
    const BlockIndex tile = tile_of(index);
    entries[slot] = {pack_index(tile), bit_of(index - tile * kTileSide), slot};
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.key != b.key ? a.key < b.key : a.bit < b.bit;
  });
  std::vector<Tile> tiles;
  for (const Entry& entry : entries) {
    if (tiles.empty() || tiles.back().key != entry.key) tiles.push_back({entry.key, 0, {}});
    tiles.back().present |= std::uint64_t{1} << entry.bit;
    tiles.back().slots.push_back(entry.slot);
  }
  return tiles;
}

std::uint64_t tile_key(const BlockIndex& block) {
  return pack_index(tile_of(block));
}

Tile tile_at(const VoxelMap& map, std::uint64_t key) {
  Tile tile{key, 0, {}};
  for (int bit = 0; bit < kTileBlocks; ++bit) {
    const std::uint32_t slot = map.find_slot(block_in_tile(key, bit));
    if (slot == kNoBlock) continue;
    tile.present |= std::uint64_t{1} << bit;
    tile.slots.push_back(slot);
  }
  return tile;
}

Tile tile_at(const VoxelMap& map, std::uint64_t key, std::uint64_t present) {
  Tile tile{key, present, {}};
  for (int bit = 0; bit < kTileBlocks; ++bit)
    if (present >> bit & 1) tile.slots.push_back(map.find_slot(block_in_tile(key, bit)));
  return tile;
}

std::vector<const VoxelBlock*> blocks_of(const VoxelMap& map, const Tile& tile) {
  std::vector<const VoxelBlock*> blocks;
  for (const std::uint32_t slot : tile.slots) blocks.push_back(&map.block(slot));
  return blocks;
}

bool valid_tile_key(std::uint64_t key) {
  constexpr int kLimit = (1 << 20) / kTileSide;  // pack_index takes block indices of 21 bits
  const BlockIndex tile = unpack_index(key);
  return pack_index(tile) == key && tile.minCoeff() >= -kLimit && tile.maxCoeff() < kLimit;
}

Tile create_tile(VoxelMap& map, std::uint64_t key, std::uint64_t present) {
  Tile tile{key, present, {}};
  for (int bit = 0; bit < kTileBlocks; ++bit)
    if (present >> bit & 1) tile.slots.push_back(map.find_or_create(block_in_tile(key, bit)));
  return tile;
}

void create_tile_away(VoxelMap& map, std::uint64_t key, std::uint64_t present) {
  for (int bit = 0; bit < kTileBlocks; ++bit)
    if (present >> bit & 1) map.create_away(block_in_tile(key, bit));
}

}  // namespace ovimap
