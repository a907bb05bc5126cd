// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/tile_keeper.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/io/map_file/map_file_access.h"

namespace ovimap {

namespace {

constexpr std::size_t kMegabyte = 1000000;
/// Of the bound; the rest is for what the next frame brings in.
constexpr double kFullShare = 0.75;
constexpr std::size_t kTilesPerTask = 2;

}  // namespace

void list_fields(MemoryConfig& config, ConfigFields& fields) {
  fields.add("max_mb", config.max_mb, 0, 1 << 30,
             "memory for the map's voxels, 10^6 bytes; what is over it goes to the checkpoint "
             "beside the map; 0: no bound");
}

int parse_megabytes(std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  const std::string_view unit(rest, static_cast<std::size_t>(end - rest));
  const double megabytes = unit == "G" ? 1000 * value : value;
  if (error != std::errc() || (unit != "M" && unit != "G") || !(megabytes >= 1) ||
      megabytes > std::numeric_limits<int>::max())
    throw Error(
        concat("'", std::string(text), "' is no amount of memory; give one as 300M or 1.5G"));
  return static_cast<int>(std::lround(megabytes));
}

TileKeeper::TileKeeper(std::filesystem::path path, Start start, const MemoryConfig& memory)
    : path_(std::move(path)), start_(start), memory_(memory), all_changed_(start == Start::kAnew) {}

CheckpointFile& TileKeeper::file() {
  if (!file_) {
    file_ = std::make_unique<CheckpointFile>(path_, start_);
    if (removed_) file_->remove_when_closed();
  }
  return *file_;
}

void TileKeeper::adopt(const std::filesystem::path& saved) {
  file().put_all(saved);
  all_changed_ = false;
}

void TileKeeper::remove() {
  removed_ = true;
  if (file_)
    file_->remove_when_closed();
  else  // what an earlier run left, be it a checkpoint or the beginning of one
    remove_map(path_);
}

void TileKeeper::note_changes(const VoxelMap& map, std::span<const std::uint32_t> slots) {
  std::optional<std::uint64_t> last;  // most blocks lie in the tile of the one before
  for (const std::uint32_t slot : slots) {
    const std::uint64_t key = tile_key(map.block_index(slot));
    if (key == last) continue;
    changed_.insert(key);
    if (bounded()) last_used_[key] = now_;
    last = key;
  }
}

std::vector<Tile> TileKeeper::take_changed(const VoxelMap& map) {
  if (std::exchange(all_changed_, false)) {
    changed_.clear();
    return tiles_of(map);
  }
  std::vector<Tile> tiles;
  for (const std::uint64_t key : std::exchange(changed_, {})) tiles.push_back(tile_at(map, key));
  return tiles;
}

std::size_t TileKeeper::used_bytes(const VoxelMap& map) const {
  return map.index_bytes() + map.blocks_in_memory() * VoxelBlock::kMostBytes;
}

std::size_t TileKeeper::bound_bytes() const {
  return static_cast<std::size_t>(memory_.max_mb) * kMegabyte;
}

double TileKeeper::full_bytes() const {
  return kFullShare * static_cast<double>(bound_bytes());
}

bool TileKeeper::wants_room(const VoxelMap& map) const {
  return bounded() && static_cast<double>(used_bytes(map)) > full_bytes();
}

void TileKeeper::require_room(const VoxelMap& map) const {
  const std::size_t used = used_bytes(map);
  if (!bounded() || used <= bound_bytes()) return;
  const auto megabytes = static_cast<std::size_t>(static_cast<double>(used) / kFullShare);
  throw Error(concat("what one frame sees takes ", used / kMegabyte, " MB of voxels, and ",
                     memory_.max_mb, " MB is the bound; give --max-memory ",
                     megabytes / kMegabyte + 1, "M or more, or larger voxels (map.voxel_size_m)"));
}

void TileKeeper::load(const VoxelMap& map, std::uint32_t slot) {
  const std::lock_guard lock(loading_);
  if (map.in_memory(slot)) return;  // another thread was faster
  auto t = timers_.measure("load_tile");
  const std::uint64_t key = tile_key(map.block_index(slot));
  const StoredTile stored = file().get(key);
  const Tile tile = tile_at(map, key, stored.present);
  std::vector<std::unique_ptr<VoxelBlock>> blocks;
  std::vector<VoxelBlock*> places;
  for (const std::uint32_t part : tile.slots) {
    blocks.push_back(map.spare_block(map.block_index(part)));
    places.push_back(blocks.back().get());
  }
  if (const std::string fault = decoder_.decode(stored.data, kMapSchema, places, map.labels());
      !fault.empty())
    throw Error(concat("map '", path_.string(), "' is damaged: tile ", key,
                       " of its voxels: ", fault, "; see to the disk and map again"));
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (!map.in_memory(tile.slots[i])) map.bring_back(tile.slots[i], std::move(blocks[i]));
  last_used_[key] = now_;
}

/// The tiles to go: least recently used first, of those that were not used since the last time.
std::vector<std::uint64_t> TileKeeper::choose_tiles(const VoxelMap& map) const {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> order;
  for (const auto& [key, used] : last_used_)
    if (used != now_) order.emplace_back(used, key);
  std::sort(order.begin(), order.end());
  auto bytes = static_cast<double>(used_bytes(map));
  std::vector<std::uint64_t> chosen;
  for (auto next = order.begin(); next != order.end() && bytes > full_bytes(); ++next) {
    chosen.push_back(next->second);
    for (const std::uint32_t slot : tile_at(map, next->second).slots)
      if (map.in_memory(slot)) bytes -= VoxelBlock::kMostBytes;
  }
  return chosen;
}

void TileKeeper::trim(const VoxelMap& map) {
  if (wants_room(map)) let_tiles_leave(map);
  if (bounded()) {
    const std::size_t used = used_bytes(map),
                      bound = static_cast<std::size_t>(memory_.max_mb) * kMegabyte;
    map.keep_spares(used < bound ? (bound - used) / VoxelBlock::kMostBytes : 0);
  }
  ++now_;
}

void TileKeeper::let_tiles_leave(const VoxelMap& map) {
  if (std::exchange(all_changed_, false))
    for (const Tile& tile : tiles_of(map)) {
      changed_.insert(tile.key);
      last_used_.try_emplace(tile.key, 0);
    }
  std::vector<Tile> tiles;
  for (const std::uint64_t key : choose_tiles(map)) tiles.push_back(tile_at(map, key));
  store_changed(map, tiles);
  for (const Tile& tile : tiles) {
    map.evict(tile.slots);
    changed_.erase(tile.key);
    last_used_.erase(tile.key);
  }
}

/// Puts those of the tiles into the file that are not there as they are.
void TileKeeper::store_changed(const VoxelMap& map, std::span<const Tile> tiles) {
  std::vector<StoredTile> stored(tiles.size());
  std::vector<StageTimers> took(tiles.size());
  parallel_for_ranges(tiles.size(), kTilesPerTask, [&](std::size_t begin, std::size_t end) {
    TileEncoder encoder;
    for (std::size_t i = begin; i < end; ++i) {
      auto t = took[i].measure("evict_tile");
      if (changed_.contains(tiles[i].key))
        stored[i] = {tiles[i].present, encoder.encode(blocks_of(map, tiles[i]))};
    }
  });
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    timers_.merge(took[i]);
    if (stored[i].present != 0) file().put(tiles[i].key, stored[i]);
  }
}

void TileKeeper::report(StageTimers& timers) {
  const std::lock_guard lock(loading_);
  timers.merge(timers_);
  timers_ = {};
}

MapDocument load_map_in(const std::shared_ptr<TileKeeper>& tiles,
                        const std::filesystem::path& map) {
  if (!tiles->bounded()) return load_map(map);
  MapDocument document = load_map_without_voxels(map);
  if (map != tiles->path()) tiles->adopt(map);
  document.map.keep_in(tiles);
  return document;
}

}  // namespace ovimap
