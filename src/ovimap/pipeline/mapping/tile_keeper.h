// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string_view>
#include <vector>

#include "ovimap/base/stage_timers.h"
#include "ovimap/io/map_file/map_checkpoint.h"
#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/io/map_tables/map_file_blocks.h"

namespace ovimap {

class ConfigFields;

struct MemoryConfig {
  int max_mb = 0;  ///< of memory for the map's voxels, 10^6 bytes; 0: no bound
};
void list_fields(MemoryConfig& config, ConfigFields& fields);

/// "300M" or "1.5G" in units of 10^6 bytes. Throws Error for anything else.
int parse_megabytes(std::string_view text);

/// The tiles of a map that is being made, and the file beside it: which tiles are not in the file
/// as they are now, and, with a bound on memory, which are in the file alone. Those that no frame
/// changed or brought back for the longest time go first.
class TileKeeper : public BlockStore {
 public:
  using Start = CheckpointFile::Start;
  /// Opens nothing before the file is needed. `start`: kGoOn where the map was loaded from `path`.
  TileKeeper(std::filesystem::path path, Start start, const MemoryConfig& memory);

  const std::filesystem::path& path() const { return path_; }
  bool bounded() const { return memory_.max_mb > 0; }
  std::size_t bound_bytes() const;
  /// From now on; where there is a bound.
  void set_bound(const MemoryConfig& memory) { memory_ = memory; }
  CheckpointFile& file();
  /// The map at hand is that of a saved file, whose tiles it goes on with.
  void adopt(const std::filesystem::path& saved);
  /// The file is not needed when this ends: the map is saved.
  void remove();

  /// A frame changed these blocks.
  void note_changes(const VoxelMap& map, std::span<const std::uint32_t> slots) override;
  /// The tiles whose voxels are not in the file as they are now; from here on they count as if they
  /// were.
  std::vector<Tile> take_changed(const VoxelMap& map);

  /// Whether `trim` has something to do.
  bool wants_room(const VoxelMap& map) const;
  void load(const VoxelMap& map, std::uint32_t slot) override;
  /// Nothing else may use the file or hold frozen blocks meanwhile.
  void trim(const VoxelMap& map) override;
  /// Throws Error when what was used since the last `trim` alone is more than the bound.
  void require_room(const VoxelMap& map) const;

  /// Adds what each tile took since the last call, as stages "evict_tile" and "load_tile".
  void report(StageTimers& timers);

 private:
  std::size_t used_bytes(const VoxelMap& map) const;
  double full_bytes() const;  ///< of voxels from which on tiles leave
  void let_tiles_leave(const VoxelMap& map);
  std::vector<std::uint64_t> choose_tiles(const VoxelMap& map) const;
  void store_changed(const VoxelMap& map, std::span<const Tile> tiles);

  std::filesystem::path path_;
  Start start_;
  MemoryConfig memory_;
  std::unique_ptr<CheckpointFile> file_;
  bool removed_ = false;
  std::set<std::uint64_t> changed_;                   ///< keys of tiles
  bool all_changed_;                                  ///< the file has nothing of the map yet
  std::map<std::uint64_t, std::uint64_t> last_used_;  ///< of tiles in memory: `now_` at that time
  std::uint64_t now_ = 1;                             ///< counts calls of trim
  std::mutex loading_;
  TileDecoder decoder_;
  StageTimers timers_;
};

/// The map of a file, with `tiles` as its store where they have a bound on memory: then its voxels
/// stay in their file, to which they are taken first where that is another. Throws what load_map
/// throws.
MapDocument load_map_in(const std::shared_ptr<TileKeeper>& tiles, const std::filesystem::path& map);

}  // namespace ovimap
