// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "ovimap/io/map_document.h"

namespace SQLite {
class Database;
}

namespace ovimap {

/// A tile whose voxels changed, as it was at one moment.
struct ChangedTile {
  std::uint64_t key = 0, present = 0;     ///< as in the table `blocks`
  std::vector<const VoxelBlock*> blocks;  ///< in the order of the bits of `present`
};

/// A map at one moment of its making.
struct MapCheckpoint {
  MapRecord record;  ///< without what only a finished map has
  VoxelMapConfig map_config;
  LabelForest labels;
  std::uint64_t blocks = 0;        ///< of the whole map
  std::vector<ChangedTile> tiles;  ///< that changed since the checkpoint before
};

/// Where the checkpoints of a run that writes `map` lie: beside it, `room.ovimap.partial`.
std::filesystem::path checkpoint_path(const std::filesystem::path& map);

/// Whether there is a file with a checkpoint; a run may have been killed before its first. Throws
/// Error when it is in use or no map.
bool holds_checkpoint(const std::filesystem::path& path);

/// The file that checkpoints go to: a map file of its own (docs/map-format.md, "Checkpoints") that
/// each write() takes from one whole state to the next. Whatever ends the program in between, the
/// file opens at the last one. One writer at a time: a second is refused. Throws Error naming the
/// file, the reason and the remedy.
class CheckpointFile {
 public:
  enum class Start {
    kAnew,  ///< a file that is there is replaced
    kGoOn,  ///< of an earlier run, which the map at hand was loaded from
  };
  CheckpointFile(std::filesystem::path path, Start start);
  ~CheckpointFile();
  CheckpointFile(CheckpointFile&&) noexcept;

  /// One transaction; on disk when it returns.
  void write(const MapCheckpoint& checkpoint);
  /// Deletes the file: the run has ended, and its map is saved.
  void remove();

 private:
  void open(Start start);
  void write_tiles(std::span<const ChangedTile> tiles);
  void note_stored_tiles();

  std::filesystem::path path_;
  std::unique_ptr<SQLite::Database> database_;
  std::unordered_map<std::uint64_t, std::uint64_t> row_hashes_;  ///< of the table `blocks`, by tile
};

}  // namespace ovimap
