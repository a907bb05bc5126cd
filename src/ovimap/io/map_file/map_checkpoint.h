// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <unordered_map>
#include <vector>

#include "ovimap/io/map_tables/map_file_blocks.h"
#include "ovimap/io/map_tables/map_file_frames.h"

namespace SQLite {
class Database;
class Transaction;
}  // namespace SQLite

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

/// Throws Error for a checkpoint that an older ovimap began: it would get voxels that are written
/// in two ways.
void require_own_checkpoint(const std::filesystem::path& path);

/// The file that checkpoints go to: a map file of its own (docs/map-format.md, "Checkpoints") that
/// each write() takes from one whole state to the next. Whatever ends the program in between, the
/// file opens at the last one. Tiles that memory cannot hold are put there between checkpoints, in
/// the transaction that the next write() commits. One writer at a time: a second is refused.
/// Threads may share it. Throws Error naming the file, the reason and the remedy; after one from
/// put() or write(), what was put since the last checkpoint is lost.
class CheckpointFile {
 public:
  enum class Start {
    kAnew,  ///< a file that is there is replaced
    kGoOn,  ///< of an earlier run, which the map at hand was loaded from
  };
  CheckpointFile(std::filesystem::path path, Start start);
  ~CheckpointFile();

  /// One transaction, with what was put; on disk when it returns.
  void write(const MapCheckpoint& checkpoint);

  void put(std::uint64_t tile, const StoredTile& stored);
  /// As last put or written, verified.
  StoredTile get(std::uint64_t tile);
  /// Puts all tiles of a saved map.
  void put_all(const std::filesystem::path& map);

  /// The run has ended, and its map is saved: from now on the file holds no checkpoint, only tiles,
  /// and goes when this object does.
  void remove_when_closed();

 private:
  void open(Start start);
  void begin();
  void insert(std::uint64_t tile, const StoredTile& stored);
  void write_tiles(std::span<const ChangedTile> tiles);
  void write_rest(const MapCheckpoint& checkpoint);
  void note_stored_tiles();

  std::filesystem::path path_;
  bool remove_ = false;
  std::mutex mutex_;  ///< guards what follows
  std::unique_ptr<SQLite::Database> database_;
  std::unique_ptr<SQLite::Transaction> transaction_;  ///< of the next checkpoint, once it has tiles
  KeptFramesTable kept_frames_;
  std::unordered_map<std::uint64_t, std::uint64_t> row_hashes_;  ///< of the table `blocks`, by tile
};

}  // namespace ovimap
