// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_file/map_file.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>
#include <string_view>

#include <SQLiteCpp/SQLiteCpp.h>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"
#include "ovimap/base/text/ascii.h"
#include "ovimap/io/corrections/map_edit_log.h"
#include "ovimap/io/corrections/map_file_corrections.h"
#include "ovimap/io/map_file/map_file_access.h"
#include "ovimap/io/map_file/map_file_by_instance.h"
#include "ovimap/io/map_file/map_file_parts.h"
#include "ovimap/io/map_tables/map_file_blocks.h"
#include "ovimap/io/map_tables/map_file_frames.h"
#include "ovimap/io/map_tables/map_file_history.h"
#include "ovimap/io/map_tables/map_file_motion.h"
#include "ovimap/io/map_tables/map_file_object_parts.h"
#include "ovimap/io/map_tables/map_file_record.h"
#include "ovimap/io/map_tables/map_file_rows.h"
#include "ovimap/io/map_tables/map_file_semantics.h"
#include "ovimap/semantics/words/written_words.h"

namespace ovimap {

namespace {

using map_tables::kBlocks;

// Tiles in memory at a time between file and voxels, and how many a thread takes at once.
constexpr std::size_t kTilesPerBatch = 256;
constexpr std::size_t kTilesPerTask = 4;

/// Those before this one keep no frames.
constexpr int kSchemaWithKeptFrames = 4;

void write_blocks(SQLite::Database& database, const VoxelMap& map) {
  RowWriter rows(database, kBlocks);
  std::vector<Bytes> data;
  for_each_part(map, [&](std::span<const Tile> tiles) {
    data.resize(tiles.size());
    parallel_for_ranges(tiles.size(), kTilesPerTask, [&](std::size_t begin, std::size_t end) {
      TileEncoder encoder;
      for (std::size_t i = begin; i < end; ++i) data[i] = encoder.encode(blocks_of(map, tiles[i]));
    });
    for (std::size_t i = 0; i < tiles.size(); ++i)
      rows.insert(tiles[i].key, tiles[i].present, stored_hash(data[i]), data[i]);
  });
  rows.finish();
}

struct StoredTileRow {
  Tile tile;
  std::int64_t hash;
  Bytes data;
};

void decode_tiles(const std::vector<StoredTileRow>& stored, int schema, VoxelMap& map) {
  std::vector<std::string> faults(stored.size());
  parallel_for_ranges(stored.size(), kTilesPerTask, [&](std::size_t begin, std::size_t end) {
    TileDecoder decoder;
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [tile, hash, data] = stored[i];
      faults[i] = stored_hash(data) == hash ? decoder.decode(data, schema, tile, map)
                                            : "it is not what was written";
    }
  });
  for (std::size_t i = 0; i < stored.size(); ++i)
    if (!faults[i].empty())
      throw Error(concat("tile ", stored[i].tile.key, " of its voxels: ", faults[i]));
}

/// Checks the places of tiles as they are read, before their blocks are made, so that a damaged
/// table cannot ask for more memory than the map had.
class TilePlaces {
 public:
  /// `blocks`: how many were written.
  TilePlaces(std::uint64_t blocks, const VoxelMap& map) : blocks_(blocks), map_(map) {
    if (blocks > VoxelRef::kMostBlocks)
      throw Error(concat("it has ", blocks, " blocks, more than a map can have"));
  }

  void expect(std::int64_t key, std::uint64_t present) {
    if (key <= last_key_ || !valid_tile_key(static_cast<std::uint64_t>(key)))
      throw Error(concat("table blocks has a tile ", key, " out of place"));
    last_key_ = key;
    if (map_.block_count() + static_cast<std::uint64_t>(std::popcount(present)) > blocks_)
      throw Error(concat("table blocks has more than the ", blocks_, " blocks that were written"));
  }

  void expect_end() const {
    if (map_.block_count() != blocks_)
      throw Error(concat("it has ", map_.block_count(), " blocks, but ", blocks_, " were written"));
  }

 private:
  std::uint64_t blocks_;
  const VoxelMap& map_;
  std::int64_t last_key_ = -1;
};

void read_blocks(SQLite::Database& database, int schema, std::uint64_t blocks, VoxelMap& map) {
  TilePlaces places(blocks, map);
  std::vector<StoredTileRow> batch;
  RowReader rows(database, kBlocks);
  for (bool more = true; more;) {
    if ((more = rows.next())) {
      const auto key = rows.integer<std::int64_t>();
      const auto present = static_cast<std::uint64_t>(rows.integer<std::int64_t>());
      places.expect(key, present);
      Tile tile = create_tile(map, static_cast<std::uint64_t>(key), present);
      const auto hash = rows.integer<std::int64_t>();
      const std::span<const std::uint8_t> data = rows.blob();
      batch.push_back({std::move(tile), hash, Bytes(data.begin(), data.end())});
    }
    if (!more || batch.size() == kTilesPerBatch) {
      decode_tiles(batch, schema, map);
      batch.clear();
    }
  }
  places.expect_end();
}

/// Where blocks are, without their voxels.
void place_blocks(SQLite::Database& database, std::uint64_t blocks, VoxelMap& map) {
  TilePlaces places(blocks, map);
  SQLite::Statement rows(database, "SELECT tile, present FROM blocks ORDER BY tile");
  while (rows.executeStep()) {
    const std::int64_t key = rows.getColumn(0).getInt64();
    const auto present = static_cast<std::uint64_t>(rows.getColumn(1).getInt64());
    places.expect(key, present);
    create_tile_away(map, static_cast<std::uint64_t>(key), present);
  }
  places.expect_end();
}

/// What was read on each object, by its super-points' views.
std::map<InstanceId, std::vector<WrittenLine>> writing_of_instances(
    SQLite::Database& database, std::span<const InstanceSummary> instances) {
  std::map<InstanceId, std::vector<WrittenLine>> result;
  if (!holds_table(database, map_tables::kWriting)) return result;
  const LabelForest forest = read_forest(database);
  std::map<Label, std::vector<WrittenLine>> by_root;
  for (auto& [view, lines] : read_writing(database, forest)) {
    std::vector<WrittenLine>& known = by_root[forest.root(view.super_point)];
    known.insert(known.end(), lines.begin(), lines.end());
  }
  for (const InstanceSummary& instance : instances) {
    std::vector<WrittenLine> lines;
    for (const Label label : instance.super_points)
      if (const auto read = by_root.find(label); read != by_root.end())
        lines.insert(lines.end(), read->second.begin(), read->second.end());
    if (!lines.empty()) result.emplace(instance.id, surest_readings(std::move(lines)));
  }
  return result;
}

/// What a recognizer tells of each object, by its super-points' views.
std::map<InstanceId, Eigen::VectorXf> things_of_instances(
    SQLite::Database& database, std::span<const InstanceSummary> instances, std::size_t things) {
  std::map<InstanceId, Eigen::VectorXf> result;
  if (things == 0) return result;
  const LabelForest forest = read_forest(database);
  std::map<Label, std::vector<ObjectView>> by_root;
  for (auto& [key, ratios] : read_recognized(database, forest, things)) {
    by_root[forest.root(key.super_point)].emplace_back().things = std::move(ratios);
  }
  for (const InstanceSummary& instance : instances) {
    std::vector<const ObjectView*> views;
    for (const Label label : instance.super_points)
      for (const ObjectView& view : by_root[label]) views.push_back(&view);
    if (!views.empty()) result.emplace(instance.id, things_of(views));
  }
  return result;
}

}  // namespace

MapInfo read_info(SQLite::Database& database, const OpenMap& file) {
  MapRecord record;
  const MapMeta meta = read_meta(database, record);
  if (has_corrections(database))
    read_corrected_instances(database, record);
  else
    read_instances(database, record, kFoundInstanceTables);
  MapInfo info;
  info.schema = file.schema();
  info.version = std::move(record.version);
  info.source = std::move(record.source);
  info.config_text = std::move(record.config_text);
  info.timings = std::move(record.timings);
  info.frames = meta.frames;
  info.history =
      read_history(database, file.schema(), meta.frames, std::numeric_limits<InstanceId>::max());
  info.mask_frames = record.mask_frames;
  info.unfinished = record.unfinished;
  info.instances = std::move(record.instances);
  info.hidden = std::move(record.hidden);
  info.locked = std::move(record.locked);
  info.parts = read_object_parts(database);
  info.names = std::move(record.names);
  info.writing_reader = std::move(record.semantics.writing_reader);
  info.writing = writing_of_instances(database, info.instances);
  info.recognizer = {std::move(record.semantics.recognizer.name), read_things(database)};
  info.things = things_of_instances(database, info.instances, info.recognizer.things.size());
  info.encoder = std::move(record.semantics.encoder);
  info.up = record.up;
  info.depth_camera = record.depth_camera;
  info.voxel_size_m = meta.map_config.voxel_size_m;
  info.blocks = meta.blocks;
  info.size_bytes = file.size_bytes();
  info.content_hash = meta.content_hash;
  return info;
}

VoxelMap read_voxels(SQLite::Database& database, int schema, const MapMeta& meta,
                     const LabelForest& forest) {
  VoxelMap map(meta.map_config);
  map.labels() = forest;
  read_blocks(database, schema, meta.blocks, map);
  // Checkpoints have no hash over all voxels, which would take longer than they may.
  const bool hashed = !meta.unfinished && schema >= kSchemaWithSteps;
  if (hashed && map.content_hash() != meta.content_hash)
    throw Error("its voxels are not those that were written");
  return map;
}

MapMeta read_found(SQLite::Database& database, int schema, LabelForest& forest, MapRecord& record) {
  const MapMeta meta = read_meta(database, record);
  read_registry(database, schema, forest, record);
  read_instances(database, record, kFoundInstanceTables);
  for (const InstanceSummary& instance : record.instances)
    for (const Label label : instance.super_points)
      if (label == kNoLabel || label > forest.last_label())
        throw Error(
            concat("table instance_super_points names label ", label, ", which was never given"));
  read_frames(database, record);
  if (schema >= kSchemaWithSuperPoints) {
    record.semantics.recognizer.things = read_things(database);
    record.semantics.looks = read_looks(database, forest, record.semantics, record.depth_camera);
  } else {
    read_by_instance(database, schema, forest, record);
  }
  if (schema >= kSchemaWithSemantics)
    record.surfaces = read_surfaces(database, map_tables::kSurfaces);
  record.parts = read_object_parts(database);
  if (schema >= kSchemaWithKeptFrames)
    record.kept_frames = read_kept_frames(database, forest, record.frames.size());
  if (static_cast<std::int64_t>(record.frames.size()) != meta.frames)
    throw Error("its frame log is not complete");
  record.edits = read_edits(database);
  record.registry.last_id = last_instance(record);
  record.history = read_history(database, schema, meta.frames, record.registry.last_id);
  read_past_objects(database, forest, record.history);
  read_motion(database, record);
  record.live_steps = read_live_steps(database);
  return meta;
}

void save_map(const std::filesystem::path& path, const VoxelMap& map, const MapRecord& record) {
  PendingMap pending(path);
  const MapMeta meta{map.config(), static_cast<std::int64_t>(record.frames.size()),
                     map.block_count(), map.content_hash()};
  pending.write([&](SQLite::Database& database) {
    write_record(database, record, meta);
    write_semantics(database, record);
    write_object_parts(database, record);
    write_surfaces(database, record.surfaces, map_tables::kSurfaces);
    write_shapes(database, record, map_tables::kObjectShapes);
    write_forest(database, map.labels());
    write_kept_frames(database, record.kept_frames);
    write_blocks(database, map);
    write_corrections(database, record, map.labels(), [&]() -> const VoxelMap& { return map; });
  });
  pending.commit();
}

void save_map(const std::filesystem::path& path, const MapDocument& document) {
  save_map(path, document.map, document);
}

void check_map_target(const std::filesystem::path& path) {
  constexpr std::string_view kOthers[] = {".ply", ".glb",  ".obj", ".pcd", ".png",
                                          ".jpg", ".json", ".csv", ".yaml"};
  const std::string ending = lower_case(path.extension().string());
  if (std::find(std::begin(kOthers), std::end(kOthers), ending) != std::end(kOthers)) {
    std::filesystem::path map = path;
    throw Error(concat("'", path.string(), "' is to be a map, but its name says ", ending,
                       "; call it ", map.replace_extension(".ovimap").string(),
                       ", `ovimap export` writes other formats"));
  }
  PendingMap pending(path);
}

MapDocument load_map(const std::filesystem::path& path) {
  MapDocument document;
  OpenMap file(path);
  file.read([&](SQLite::Database& database) {
    LabelForest forest = read_forest(database);
    const MapMeta meta = read_found(database, file.schema(), forest, document);
    document.map = read_voxels(database, file.schema(), meta, forest);
  });
  return document;
}

MapDocument load_map_without_voxels(const std::filesystem::path& path) {
  MapDocument document;
  OpenMap file(path);
  file.read([&](SQLite::Database& database) {
    LabelForest forest = read_forest(database);
    const MapMeta meta = read_found(database, file.schema(), forest, document);
    document.map = VoxelMap(meta.map_config);
    document.map.labels() = forest;
    place_blocks(database, meta.blocks, document.map);
  });
  return document;
}

MapInfo read_map_info(const std::filesystem::path& path) {
  OpenMap file(path);
  MapInfo info;
  file.read([&](SQLite::Database& database) { info = read_info(database, file); });
  return info;
}

MapIdentity read_map_identity(const std::filesystem::path& path) {
  OpenMap file(path);
  MapIdentity identity;
  file.read([&](SQLite::Database& database) {
    MapRecord record;
    const MapMeta meta = read_meta(database, record);
    TableHash revision;
    SQLite::Statement checks(database, "SELECT name, rows, hash FROM checks WHERE name <> 'meta'");
    while (checks.executeStep()) {
      revision.add(checks.getColumn(0).getString());
      revision.add(std::int64_t{checks.getColumn(1).getInt64()});
      revision.add(std::int64_t{checks.getColumn(2).getInt64()});
      revision.end_row();
    }
    const EncoderIdentity& encoder = record.semantics.encoder;
    for (const std::string& text : {encoder.name, encoder.digest}) revision.add(text);
    revision.add(std::int64_t{encoder.dimension});
    revision.add(static_cast<std::int64_t>(meta.content_hash));
    revision.end_row();
    identity = {record.source,     meta.frames, meta.unfinished,
                meta.content_hash, encoder,     static_cast<std::uint64_t>(revision.sum())};
  });
  return identity;
}

}  // namespace ovimap
