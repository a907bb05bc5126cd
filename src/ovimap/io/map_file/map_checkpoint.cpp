// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_file/map_checkpoint.h"

#include <algorithm>
#include <exception>
#include <numeric>

#include <SQLiteCpp/SQLiteCpp.h>

#include "ovimap/base/error.h"
#include "ovimap/io/corrections/map_edit_log.h"
#include "ovimap/io/map_file/map_file_access.h"
#include "ovimap/io/map_file/map_file_guard.h"
#include "ovimap/io/map_tables/map_file_blocks.h"
#include "ovimap/io/map_tables/map_file_object_parts.h"
#include "ovimap/io/map_tables/map_file_record.h"
#include "ovimap/io/map_tables/map_file_rows.h"
#include "ovimap/io/map_tables/map_file_semantics.h"

namespace ovimap {

namespace {

using map_tables::kBlocks;

/// The check of a row of `blocks`.
std::uint64_t row_hash(std::int64_t key, std::int64_t present, std::int64_t hash,
                       std::span<const std::uint8_t> data) {
  TableHash row;
  row.add(key);
  row.add(present);
  row.add(hash);
  row.add(data);
  row.end_row();
  return static_cast<std::uint64_t>(row.sum());
}

/// Everything but voxels and kept frames is small, and written anew.
void clear_small_tables(SQLite::Database& database) {
  for (const MapTable* table : map_tables::kAll)
    if (table != &kBlocks && table != &map_tables::kKeptFrames && has_table(database, *table))
      database.exec(concat("DELETE FROM ", table->name));
}

}  // namespace

std::filesystem::path checkpoint_path(const std::filesystem::path& map) {
  std::filesystem::path path = map;
  return path += kCheckpointEnding;
}

bool holds_checkpoint(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return false;
  bool found = false;
  reporting_write_faults(path, nullptr, [&] {
    check_journal(path);
    const auto database = open_guarded(path.string(), SQLite::OPEN_READWRITE, kLongestValue);
    found = database->tableExists(map_tables::kMeta.name);
  });
  return found;
}

namespace {

void require_own_schema(const std::filesystem::path& path, int schema) {
  if (schema < kSchemaWithSteps)
    throw Error(concat("'", path.string(),
                       "' was begun by an older ovimap, which writes voxels in another way; go on "
                       "with that one, or delete the file to begin anew"));
}

}  // namespace

void require_own_checkpoint(const std::filesystem::path& path) {
  require_own_schema(path, OpenMap(path).schema());
}

CheckpointFile::CheckpointFile(std::filesystem::path path, Start start) : path_(std::move(path)) {
  reporting_write_faults(path_, nullptr, [&] { open(start); });
}

CheckpointFile::~CheckpointFile() {
  transaction_.reset();
  database_.reset();
  if (remove_) remove_map(path_);
}

void CheckpointFile::open(Start start) {
  if (start == Start::kAnew) {
    if (holds_checkpoint(path_))  // throws where another run, begun since, is writing it
      throw Error(concat("another run left '", path_.string(),
                         "' since this one began; give this one another map to write"));
    remove_map(path_);
  }
  database_ = open_growing_map(path_);
  if (start == Start::kGoOn) {
    require_own_schema(path_, database_->execAndGet("PRAGMA user_version").getInt());
    read_as_map(path_, *database_, [&](SQLite::Database& database) {
      check_schema(database);
      note_stored_tiles();
    });
  }
  create_table(*database_, kBlocks);
}

void CheckpointFile::note_stored_tiles() {
  SQLite::Statement rows(*database_, "SELECT tile, present, hash, data FROM blocks");
  while (rows.executeStep()) {
    const SQLite::Column data = rows.getColumn(3);
    const std::int64_t key = rows.getColumn(0).getInt64();
    row_hashes_[static_cast<std::uint64_t>(key)] =
        row_hash(key, rows.getColumn(1).getInt64(), rows.getColumn(2).getInt64(),
                 {static_cast<const std::uint8_t*>(data.getBlob()),
                  static_cast<std::size_t>(data.getBytes())});
  }
}

void CheckpointFile::begin() {
  if (!transaction_) transaction_ = std::make_unique<SQLite::Transaction>(*database_);
}

void CheckpointFile::write(const MapCheckpoint& checkpoint) {
  try {
    reporting_write_faults(path_, database_.get(), [&] {
      write_tiles(checkpoint.tiles);
      write_rest(checkpoint);
    });
  } catch (...) {
    const std::lock_guard lock(mutex_);
    transaction_.reset();  // takes it back
    throw;
  }
}

void CheckpointFile::write_rest(const MapCheckpoint& checkpoint) {
  const std::lock_guard lock(mutex_);
  begin();
  clear_small_tables(*database_);
  const MapMeta meta{checkpoint.map_config,
                     static_cast<std::int64_t>(checkpoint.record.frames.size()), checkpoint.blocks,
                     0, true};
  write_record(*database_, checkpoint.record, meta);
  write_semantics(*database_, checkpoint.record);
  write_object_parts(*database_, checkpoint.record);
  write_surfaces(*database_, checkpoint.record.surfaces, map_tables::kSurfaces);
  write_forest(*database_, checkpoint.labels);
  kept_frames_.update(*database_, checkpoint.record.kept_frames);
  if (!checkpoint.record.edits.empty()) write_edits(*database_, checkpoint.record.edits);
  const std::uint64_t sum =
      std::accumulate(row_hashes_.begin(), row_hashes_.end(), std::uint64_t{0},
                      [](std::uint64_t total, const auto& entry) { return total + entry.second; });
  write_check(*database_, kBlocks, static_cast<std::int64_t>(row_hashes_.size()),
              static_cast<std::int64_t>(sum));
  transaction_->commit();
  transaction_.reset();
}

/// Encodes outside the lock, so that tiles can be read meanwhile.
void CheckpointFile::write_tiles(std::span<const ChangedTile> tiles) {
  TileEncoder encoder;
  for (const ChangedTile& tile : tiles) {
    const StoredTile stored{tile.present, encoder.encode(tile.blocks)};
    const std::lock_guard lock(mutex_);
    insert(tile.key, stored);
  }
}

void CheckpointFile::insert(std::uint64_t tile, const StoredTile& stored) {
  begin();
  SQLite::Statement insert(
      *database_, "INSERT OR REPLACE INTO blocks (tile, present, hash, data) VALUES (?, ?, ?, ?)");
  const auto key = static_cast<std::int64_t>(tile),
             present = static_cast<std::int64_t>(stored.present);
  const std::int64_t hash = stored_hash(stored.data);
  insert.bind(1, key);
  insert.bind(2, present);
  insert.bind(3, hash);
  insert.bindNoCopy(4, stored.data.data(), static_cast<int>(stored.data.size()));
  insert.exec();
  row_hashes_[tile] = row_hash(key, present, hash, stored.data);
}

void CheckpointFile::put(std::uint64_t tile, const StoredTile& stored) {
  const std::lock_guard lock(mutex_);
  reporting_write_faults(path_, database_.get(), [&] { insert(tile, stored); });
}

StoredTile CheckpointFile::get(std::uint64_t tile) {
  const std::lock_guard lock(mutex_);
  std::optional<StoredTile> stored;
  reporting_write_faults(path_, database_.get(), [&] { stored = read_tile(*database_, tile); });
  if (!stored)
    throw Error(concat("map '", path_.string(), "' is damaged: tile ", tile,
                       " of its voxels is not what was written; see to the disk and map again"));
  return *std::move(stored);
}

void CheckpointFile::put_all(const std::filesystem::path& map) {
  std::exception_ptr fault;  // to write is no fault of the map that is read
  OpenMap file(map);
  file.read([&](SQLite::Database& database) {
    const LabelForest forest = read_forest(database);
    RowReader rows(database, kBlocks);
    while (!fault && rows.next()) {
      const auto key = rows.integer<std::int64_t>(), present = rows.integer<std::int64_t>(),
                 hash = rows.integer<std::int64_t>();
      const std::span<const std::uint8_t> data = rows.blob();
      if (stored_hash(data) != hash)
        rows.fail(concat("has a tile ", key, " that is not what was written"));
      StoredTile tile{static_cast<std::uint64_t>(present), Bytes(data.begin(), data.end())};
      if (const std::string wrong = renew_tile(tile, file.schema(), forest); !wrong.empty())
        rows.fail(concat("has a tile ", key, " that cannot be read: ", wrong));
      try {
        put(static_cast<std::uint64_t>(key), tile);
      } catch (const Error&) {
        fault = std::current_exception();
      }
    }
  });
  if (fault) std::rethrow_exception(fault);
}

void CheckpointFile::remove_when_closed() {
  const std::lock_guard lock(mutex_);
  remove_ = true;
  try {  // tiles may be needed for long; killed meanwhile, the file must not pass for unfinished
    begin();
    database_->exec(concat("DROP TABLE IF EXISTS ", map_tables::kMeta.name));
    transaction_->commit();
  } catch (const SQLite::Exception&) {  // the map is saved, and this file goes soon
  }
  transaction_.reset();
}

}  // namespace ovimap
