// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_file/saved_tiles.h"

#include <vector>

#include "ovimap/io/map_file/map_file.h"

namespace ovimap {

SavedTiles::SavedTiles(const std::filesystem::path& map, std::size_t max_bytes)
    : path_(map), max_bytes_(max_bytes), file_(map) {}

StoredTile SavedTiles::read(std::uint64_t tile) {
  const std::lock_guard lock(reading_);
  std::optional<StoredTile> stored;
  file_.read([&](SQLite::Database& database) {
    stored = read_tile(database, tile);
    if (!stored) throw Error(concat("tile ", tile, " of its voxels is not what was written"));
  });
  return *std::move(stored);
}

void SavedTiles::load(const VoxelMap& map, std::uint32_t slot) {
  const std::uint64_t key = tile_key(map.block_index(slot));
  const StoredTile stored = read(key);
  const Tile tile = tile_at(map, key);
  std::vector<std::unique_ptr<VoxelBlock>> blocks;
  std::vector<VoxelBlock*> places;
  {
    const std::lock_guard lock(placing_);
    if (map.in_memory(slot)) return;  // another thread was faster
    for (const std::uint32_t part : tile.slots) {
      blocks.push_back(map.spare_block(map.block_index(part)));
      places.push_back(blocks.back().get());
    }
  }
  thread_local TileDecoder decoder;
  const std::string fault = stored.present != tile.present
                                ? "it has other blocks than when the map was opened"
                                : decoder.decode(stored.data, file_.schema(), places, map.labels());
  if (!fault.empty())
    throw DamagedMap(concat("map '", path_.string(), "' is damaged: tile ", key,
                            " of its voxels: ", fault, "; see to the disk and map again"));
  const std::lock_guard lock(placing_);
  in_memory_.insert(key);
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (!map.in_memory(tile.slots[i])) map.bring_back(tile.slots[i], std::move(blocks[i]));
}

void SavedTiles::trim(const VoxelMap& map) {
  const std::lock_guard lock(placing_);
  if (map.blocks_in_memory() * VoxelBlock::kMostBytes <= max_bytes_) return;
  for (const std::uint64_t key : in_memory_) map.evict(tile_at(map, key).slots);
  in_memory_.clear();
}

MapDocument load_map_by_tiles(const std::filesystem::path& path, std::size_t max_bytes) {
  auto tiles = std::make_shared<SavedTiles>(path, max_bytes);
  MapDocument document = load_map_without_voxels(path);
  document.map.keep_in(std::move(tiles));
  return document;
}

}  // namespace ovimap
