// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_tables/map_file_record.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <functional>
#include <limits>

#include "ovimap/base/config.h"
#include "ovimap/io/map_tables/map_file_history.h"
#include "ovimap/io/map_tables/map_file_rows.h"

namespace ovimap {

namespace {

using namespace map_tables;

/// Every plain value of a map by its key in the table `meta`. Written and read through this one
/// list; a key that a file lacks keeps its default.
void list_meta(MapRecord& record, VoxelMapConfig& map_config, ConfigFields& fields) {
  constexpr int kMostPixels = 1 << 20;
  constexpr float kMostFocalPixels = 1e9f;
  fields.add("version", record.version, "of the program that wrote the map");
  fields.add("source", record.source, "where the frames came from");
  fields.add("config", record.config_text, "effective configuration");
  fields.add("timings", record.timings, "how long the stages of a frame took");
  fields.add("mask_frames", record.mask_frames, 0, std::numeric_limits<int>::max(),
             "frames with 2D masks");
  fields.add("entity_frames", record.registry.entity_frames, 0, std::numeric_limits<int>::max(),
             "frames that entity_sightings counts");
  fields.add("registry_frames", record.registry.frames, 0, std::numeric_limits<int>::max(),
             "frames that super_point_frames counts");
  fields.add("unfinished", record.unfinished, "the map is a checkpoint of a run");
  fields.group("up", [&](ConfigFields& up) {
    up.add("x", record.up.x(), -1.f, 1.f, "away from the ground, in the world");
    up.add("y", record.up.y(), -1.f, 1.f, "away from the ground, in the world");
    up.add("z", record.up.z(), -1.f, 1.f, "away from the ground, in the world");
  });
  fields.group("depth_camera", [&](ConfigFields& camera) {
    camera.add("width", record.depth_camera.width, 0, kMostPixels, "pixels");
    camera.add("height", record.depth_camera.height, 0, kMostPixels, "pixels");
    camera.add("fx", record.depth_camera.fx, 0.f, kMostFocalPixels, "pixels");
    camera.add("fy", record.depth_camera.fy, 0.f, kMostFocalPixels, "pixels");
    camera.add("cx", record.depth_camera.cx, -kMostFocalPixels, kMostFocalPixels, "pixels");
    camera.add("cy", record.depth_camera.cy, -kMostFocalPixels, kMostFocalPixels, "pixels");
  });
  fields.group("encoder", [&](ConfigFields& encoder) {
    constexpr int kMostDimensions = 1 << 16;
    encoder.add("name", record.semantics.encoder.name, "model whose embeddings these are");
    encoder.add("dimension", record.semantics.encoder.dimension, 0, kMostDimensions,
                "numbers of an embedding");
    encoder.add("digest", record.semantics.encoder.digest, "SHA-256 over the model's files");
  });
  fields.group("writing", [&](ConfigFields& writing) {
    writing.add("reader", record.semantics.writing_reader, "model that read what is written");
  });
  fields.group("recognizer", [&](ConfigFields& recognizer) {
    recognizer.add("name", record.semantics.recognizer.name, "models that recognized things");
  });
  fields.group("views", [&](ConfigFields& views) { list_fields(record.semantics.views, views); });
  fields.group("crops", [&](ConfigFields& crops) { list_fields(record.semantics.crops, crops); });
  fields.group("map", [&](ConfigFields& map) { list_fields(map_config, map); });
  fields.group("instance",
               [&](ConfigFields& instance) { list_fields(record.instance_config, instance); });
}

std::uint64_t parse_number(const std::map<std::string, std::string>& meta, const std::string& key,
                           int base, std::uint64_t max) {
  const auto found = meta.find(key);
  if (found == meta.end()) throw Error(concat("table meta has no ", key));
  const std::string& text = found->second;
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc() || end != text.data() + text.size() || value > max)
    throw Error(concat("table meta has no usable ", key));
  return value;
}

void write_meta(SQLite::Database& database, const MapRecord& record, const MapMeta& meta) {
  MapRecord plain;
  plain.version = record.version;
  plain.source = record.source;
  plain.config_text = record.config_text;
  plain.timings = record.timings;
  plain.mask_frames = record.mask_frames;
  plain.registry.entity_frames = record.registry.entity_frames;
  plain.registry.frames = record.registry.frames;
  plain.unfinished = record.unfinished;
  plain.up = record.up;
  plain.depth_camera = record.depth_camera;
  plain.instance_config = record.instance_config;
  plain.semantics.encoder = record.semantics.encoder;
  plain.semantics.writing_reader = record.semantics.writing_reader;
  plain.semantics.recognizer.name = record.semantics.recognizer.name;
  plain.semantics.views = record.semantics.views;
  plain.semantics.crops = record.semantics.crops;
  VoxelMapConfig map_config = meta.map_config;
  ConfigFields fields;
  list_meta(plain, map_config, fields);
  RowWriter rows(database, kMeta);
  for (const ConfigField& field : fields.fields()) {
    const std::string text = field.get();
    field.set(text);  // what cannot be read again must not be written
    rows.insert(field.name, text);
  }
  rows.insert(std::string("frames"), std::to_string(meta.frames));
  rows.insert(std::string("blocks"), std::to_string(meta.blocks));
  rows.insert(std::string("last_instance_id"), std::to_string(record.registry.last_id));
  rows.insert(std::string("content_hash"), hash_text(meta.content_hash));
  rows.finish();
}

/// Pose as bytes: the upper three rows, row by row, 12 little-endian doubles. A column each would
/// cost readers more than it tells them.
std::array<std::uint8_t, 96> pose_bytes(const Pose& pose) {
  std::array<std::uint8_t, 96> bytes;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto number = static_cast<Eigen::Index>(i / 8);
    const double value = pose.matrix()(number / 4, number % 4);
    bytes[i] = static_cast<std::uint8_t>(std::bit_cast<std::uint64_t>(value) >> 8 * (i % 8));
  }
  return bytes;
}

Pose pose_from(std::span<const std::uint8_t> bytes) {
  Pose pose = Pose::Identity();
  for (std::size_t number = 0; number < 12; ++number) {
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < 8; ++i) word |= std::uint64_t{bytes[number * 8 + i]} << 8 * i;
    pose.matrix()(static_cast<Eigen::Index>(number / 4), static_cast<Eigen::Index>(number % 4)) =
        std::bit_cast<double>(word);
  }
  return pose;
}

void write_frames(SQLite::Database& database, const MapRecord& record) {
  RowWriter rows(database, kFrames);
  for (std::size_t i = 0; i < record.frames.size(); ++i) {
    const FrameLogEntry& frame = record.frames[i];
    const auto pose = pose_bytes(frame.world_from_camera);
    rows.insert(i, frame.index, frame.timestamp_s, frame.name, std::span<const std::uint8_t>(pose),
                frame.labelled);
  }
  rows.finish();
}

/// Two 32-bit numbers a run.
Bytes run_bytes(const FrameRuns& frames) {
  Bytes bytes;
  for (const FrameRuns::Run& run : frames.runs())
    for (const std::uint32_t bound : {run.begin, run.end})
      for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(bound >> 8 * i));
  return bytes;
}

FrameRuns runs_from(RowReader& rows) {
  const std::span<const std::uint8_t> bytes = rows.blob();
  std::vector<std::uint32_t> bounds(bytes.size() / 4);
  for (std::size_t i = 0; i < bounds.size() * 4; ++i)
    bounds[i / 4] |= std::uint32_t{bytes[i]} << 8 * (i % 4);
  const auto disordered = std::adjacent_find(bounds.begin(), bounds.end(), std::greater_equal<>());
  if (bytes.size() % 8 != 0 || disordered != bounds.end())
    rows.fail("has runs of frames out of order");
  std::vector<FrameRuns::Run> runs;
  for (std::size_t i = 0; i < bounds.size(); i += 2) runs.push_back({bounds[i], bounds[i + 1]});
  return FrameRuns(std::move(runs));
}

void write_registry(SQLite::Database& database, const InstanceRegistry::State& state) {
  RowWriter points(database, kSuperPoints);
  for (const auto& [label, point] : state.super_points) points.insert(label, point.frames_seen);
  points.finish();
  RowWriter votes(database, kVotes);
  for (const auto& [label, point] : state.super_points)
    for (const auto& [id, count] : point.votes) votes.insert(label, id, count);
  votes.finish();
  RowWriter pairs(database, kLabelPairs);
  for (const auto& [pair, count] : state.pair_counts)
    pairs.insert(pair.first, pair.second, count.joined, count.apart);
  pairs.finish();
  RowWriter sightings(database, kEntitySightings);
  for (const auto& [label, seen] : state.entity_sightings)
    for (const auto& [frame, entity] : seen) sightings.insert(label, frame, entity);
  sightings.finish();
  RowWriter frames(database, kSuperPointFrames);
  for (const auto& [label, point] : state.super_points) {
    if (point.seen.runs().empty()) continue;
    const Bytes runs = run_bytes(point.seen);
    frames.insert(label, point.first_frame, point.last_frame, std::span<const std::uint8_t>(runs));
  }
  frames.finish();
  RowWriter aliases(database, kInstanceAliases);
  for (const auto& [id, target] : state.aliases) aliases.insert(id, target);
  aliases.finish();
}

}  // namespace

Label take_label(RowReader& rows, const LabelForest& forest) {
  const auto label = rows.integer<Label>();
  if (label == kNoLabel || label > forest.last_label())
    rows.fail(concat("names label ", label, ", which was never given"));
  return label;
}

InstanceId take_instance(RowReader& rows, InstanceId last_id) {
  const auto id = rows.integer<InstanceId>();
  if (id == 0 || id > last_id) rows.fail(concat("names instance ", id, ", which was never given"));
  return id;
}

std::string hash_text(std::uint64_t hash) {
  std::string text(16, '0');
  for (auto digit = text.rbegin(); digit != text.rend(); ++digit, hash >>= 4)
    *digit = "0123456789abcdef"[hash & 15];
  return text;
}

void write_instances(SQLite::Database& database, const MapRecord& record,
                     const InstanceTables& tables) {
  RowWriter instances(database, tables.instances);
  for (const InstanceSummary& instance : record.instances) {
    const auto &low = instance.box.min(), &high = instance.box.max(), &center = instance.centroid;
    instances.insert(instance.id, low.x(), low.y(), low.z(), high.x(), high.y(), high.z(),
                     center.x(), center.y(), center.z(), instance.points, instance.views);
  }
  instances.finish();
  RowWriter super_points(database, tables.super_points);
  for (const InstanceSummary& instance : record.instances)
    for (Label label : instance.super_points) super_points.insert(instance.id, label);
  super_points.finish();
  RowWriter names(database, tables.names);
  for (const auto& [id, name] : record.names) names.insert(id, name);
  names.finish();
}

void write_record(SQLite::Database& database, const MapRecord& record, const MapMeta& meta) {
  write_meta(database, record, meta);
  write_instances(database, record, kFoundInstanceTables);
  write_frames(database, record);
  write_registry(database, record.registry);
  write_history(database, record.history);
}

void write_forest(SQLite::Database& database, const LabelForest& forest) {
  Bytes roots;
  roots.reserve(forest.roots().size() * 4);
  for (Label root : forest.roots())
    for (int i = 0; i < 4; ++i) roots.push_back(static_cast<std::uint8_t>(root >> 8 * i));
  RowWriter rows(database, kLabelForest);
  rows.insert(forest.epoch(), roots);
  rows.finish();
}

LabelForest read_forest(SQLite::Database& database) {
  std::vector<Label> roots;
  std::uint32_t epoch = 0;
  RowReader rows(database, kLabelForest);
  while (rows.next()) {
    epoch = rows.integer<std::uint32_t>();
    const std::span<const std::uint8_t> bytes = rows.blob();
    roots.assign(bytes.size() / 4, 0);
    for (std::size_t i = 0; i < roots.size() * 4; ++i)
      roots[i / 4] |= Label{bytes[i]} << 8 * (i % 4);
  }
  return LabelForest::from_roots(std::move(roots), epoch);
}

MapMeta read_meta(SQLite::Database& database, MapRecord& record) {
  std::map<std::string, std::string> texts;
  RowReader rows(database, kMeta);
  while (rows.next()) {
    std::string key = rows.text();
    texts[std::move(key)] = rows.text();
  }
  MapMeta meta;
  ConfigFields fields;
  list_meta(record, meta.map_config, fields);
  for (const ConfigField& field : fields.fields())
    if (const auto found = texts.find(field.name); found != texts.end()) field.set(found->second);
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  meta.frames = static_cast<std::int64_t>(parse_number(texts, "frames", 10, kMost));
  meta.blocks = parse_number(texts, "blocks", 10, kMost);
  record.registry.last_id = static_cast<InstanceId>(
      parse_number(texts, "last_instance_id", 10, std::numeric_limits<InstanceId>::max()));
  meta.content_hash =
      parse_number(texts, "content_hash", 16, std::numeric_limits<std::uint64_t>::max());
  record.content_hash = meta.content_hash;
  meta.unfinished = record.unfinished;
  return meta;
}

void read_instances(SQLite::Database& database, MapRecord& record, const InstanceTables& tables) {
  std::map<InstanceId, InstanceSummary> instances;
  RowReader rows(database, tables.instances);
  while (rows.next()) {
    InstanceSummary instance;
    instance.id = rows.integer<InstanceId>();
    for (Eigen::Vector3f* corner : {&instance.box.min(), &instance.box.max(), &instance.centroid})
      for (float& coordinate : *corner) coordinate = static_cast<float>(rows.real());
    instance.points = rows.integer<std::size_t>();
    instance.views = rows.integer<int>();
    instances.emplace(instance.id, std::move(instance));
  }
  RowReader super_points(database, tables.super_points);
  while (super_points.next()) {
    const auto found = instances.find(super_points.integer<InstanceId>());
    const auto label = super_points.integer<Label>();
    if (found == instances.end()) super_points.fail("names an instance that is not there");
    found->second.super_points.push_back(label);
  }
  for (auto& [id, instance] : instances) record.instances.push_back(std::move(instance));
  RowReader names(database, tables.names);
  while (names.next()) {
    const auto id = names.integer<InstanceId>();
    record.names[id] = names.text();
  }
}

void read_frames(SQLite::Database& database, MapRecord& record) {
  RowReader rows(database, kFrames);
  while (rows.next()) {
    if (rows.integer<std::size_t>() != record.frames.size()) rows.fail("has a gap");
    FrameLogEntry frame;
    frame.index = rows.integer<std::int64_t>();
    frame.timestamp_s = rows.real();
    frame.name = rows.text();
    const std::span<const std::uint8_t> pose = rows.blob();
    if (pose.size() != pose_bytes(frame.world_from_camera).size())
      rows.fail(concat("has a pose of ", pose.size(), " bytes"));
    frame.world_from_camera = pose_from(pose);
    frame.labelled = rows.integer<int>() != 0;
    record.frames.push_back(std::move(frame));
  }
}

/// Maps of earlier schemas know nothing of which 2D entities showed a super-point.
constexpr int kSchemaWithConsensus = 3;

EntitySightings read_sightings(SQLite::Database& database, const LabelForest& forest) {
  EntitySightings sightings;
  RowReader rows(database, kEntitySightings);
  while (rows.next()) {
    std::vector<EntitySighting>& seen = sightings[take_label(rows, forest)];
    const auto frame = rows.integer<std::uint32_t>();
    seen.push_back({frame, rows.integer<std::uint16_t>()});
  }
  return sightings;
}

/// Which frames showed each super-point.
void read_super_point_frames(SQLite::Database& database, const LabelForest& forest,
                             std::map<Label, SuperPoint>& super_points) {
  RowReader rows(database, kSuperPointFrames);
  while (rows.next()) {
    SuperPoint& point = super_points[take_label(rows, forest)];
    point.first_frame = rows.integer<std::int64_t>();
    point.last_frame = rows.integer<std::int64_t>();
    point.seen = runs_from(rows);
  }
}

void read_registry(SQLite::Database& database, int schema, const LabelForest& forest,
                   MapRecord& record) {
  InstanceRegistry::State& state = record.registry;
  RowReader points(database, kSuperPoints);
  while (points.next()) {
    const Label label = take_label(points, forest);
    state.super_points[label].frames_seen = points.integer<int>();
  }
  RowReader votes(database, kVotes);
  while (votes.next()) {
    const auto point = state.super_points.find(take_label(votes, forest));
    const InstanceId id = take_instance(votes, state.last_id);
    if (point == state.super_points.end()) votes.fail("names a super-point that is not there");
    point->second.votes[id] = votes.integer<int>();
  }
  RowReader pairs(database, kLabelPairs);
  while (pairs.next()) {
    const Label lower = take_label(pairs, forest), higher = take_label(pairs, forest);
    SuperPointMerging::PairCount& count = state.pair_counts[{lower, higher}];
    count.joined = pairs.integer<int>();
    count.apart = pairs.integer<int>();
  }
  if (schema >= kSchemaWithConsensus) state.entity_sightings = read_sightings(database, forest);
  if (schema >= kSchemaWithSuperPoints)
    read_super_point_frames(database, forest, state.super_points);
  RowReader aliases(database, kInstanceAliases);
  while (aliases.next()) {
    const InstanceId id = take_instance(aliases, state.last_id);
    const InstanceId target = take_instance(aliases, state.last_id);
    if (target >= id) aliases.fail(concat("makes ", target, " stand for the older ", id));
    state.aliases[id] = target;
  }
}

}  // namespace ovimap
