// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_tables/map_file_record.h"

#include <algorithm>
#include <array>
#include <bit>
#include <set>

#include "ovimap/base/text/printable.h"
#include "ovimap/io/map_tables/map_file_frames.h"
#include "ovimap/io/map_tables/map_file_history.h"
#include "ovimap/io/map_tables/map_file_motion.h"
#include "ovimap/io/map_tables/map_file_rows.h"

namespace ovimap {

namespace {

using namespace map_tables;

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

void write_sightings(SQLite::Database& database, const EntitySightings& sightings) {
  RowWriter rows(database, kEntitySightings);
  std::set<EntitySighting> rated;
  for (const auto& [label, seen] : sightings)
    for (const EntitySighting& sighting : seen) {
      rows.insert(label, sighting.frame, sighting.entity);
      if (sighting.is_rated()) rated.insert(sighting);
    }
  rows.finish();
  if (rated.empty()) return;
  RowWriter ratings(database, kEntityRatings);
  for (const EntitySighting& sighting : rated)
    ratings.insert(sighting.frame, sighting.entity, sighting.rating);
  ratings.finish();
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
  write_sightings(database, state.entity_sightings);
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

void write_confidences(SQLite::Database& database, const MapRecord& record, const MapTable& table) {
  const auto is_rated = [](const InstanceSummary& one) { return one.confidence.has_value(); };
  if (std::none_of(record.instances.begin(), record.instances.end(), is_rated)) return;
  RowWriter rows(database, table);
  for (const InstanceSummary& instance : record.instances)
    if (instance.confidence) rows.insert(instance.id, *instance.confidence);
  rows.finish();
}

void read_confidences(SQLite::Database& database, const MapTable& table,
                      std::map<InstanceId, InstanceSummary>& instances) {
  if (!holds_table(database, table)) return;
  RowReader rows(database, table);
  while (rows.next()) {
    const auto found = instances.find(rows.integer<InstanceId>());
    if (found == instances.end()) rows.fail("names an instance that is not there");
    const auto confidence = static_cast<float>(rows.real());
    if (!(confidence >= 0 && confidence <= 1)) rows.fail("has a confidence beyond 0 and 1");
    found->second.confidence = confidence;
  }
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
  write_confidences(database, record, tables.confidences);
}

void write_record(SQLite::Database& database, const MapRecord& record, const MapMeta& meta) {
  write_meta(database, record, meta);
  write_instances(database, record, kFoundInstanceTables);
  write_frames(database, record);
  write_registry(database, record.registry);
  write_history(database, record.history);
  write_motion(database, record);
  write_live_steps(database, record.live_steps);
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

void read_instances(SQLite::Database& database, MapRecord& record, const InstanceTables& tables) {
  std::map<InstanceId, InstanceSummary> instances;
  RowReader rows(database, tables.instances);
  while (rows.next()) {
    InstanceSummary instance;
    instance.id = rows.integer<InstanceId>();
    for (Eigen::Vector3f* corner : {&instance.box.min(), &instance.box.max(), &instance.centroid})
      for (float& coordinate : *corner) coordinate = static_cast<float>(rows.real());
    if (!instance.box.min().allFinite() || !instance.box.max().allFinite() ||
        !instance.centroid.allFinite())
      rows.fail("has an object whose place is not finite");
    instance.points = rows.integer<std::size_t>();
    instance.views = rows.integer<int>();
    instances.emplace(instance.id, std::move(instance));
  }
  std::set<Label> owned;
  RowReader super_points(database, tables.super_points);
  while (super_points.next()) {
    const auto found = instances.find(super_points.integer<InstanceId>());
    const auto label = super_points.integer<Label>();
    if (found == instances.end()) super_points.fail("names an instance that is not there");
    if (!owned.insert(label).second) super_points.fail("gives a super-point to two instances");
    found->second.super_points.push_back(label);
  }
  read_confidences(database, tables.confidences, instances);
  for (auto& [id, instance] : instances) record.instances.push_back(std::move(instance));
  RowReader names(database, tables.names);
  while (names.next()) {
    const auto id = names.integer<InstanceId>();
    record.names[id] = printable(names.text());
  }
}

void read_frames(SQLite::Database& database, MapRecord& record) {
  RowReader rows(database, kFrames);
  while (rows.next()) {
    if (rows.integer<std::size_t>() != record.frames.size()) rows.fail("has a gap");
    FrameLogEntry frame;
    frame.index = rows.integer<std::int64_t>();
    frame.timestamp_s = rows.real();
    frame.name = printable(rows.text());
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

/// Of masks below the highest, by frame and entity.
std::map<std::pair<std::uint32_t, std::uint16_t>, std::uint8_t> read_ratings(
    SQLite::Database& database) {
  std::map<std::pair<std::uint32_t, std::uint16_t>, std::uint8_t> ratings;
  if (!holds_table(database, kEntityRatings)) return ratings;
  RowReader rows(database, kEntityRatings);
  while (rows.next()) {
    const auto frame = rows.integer<std::uint32_t>();
    const auto entity = rows.integer<std::uint16_t>();
    ratings[{frame, entity}] = rows.integer<std::uint8_t>();
  }
  return ratings;
}

EntitySightings read_sightings(SQLite::Database& database, const LabelForest& forest) {
  const auto ratings = read_ratings(database);
  EntitySightings sightings;
  RowReader rows(database, kEntitySightings);
  while (rows.next()) {
    std::vector<EntitySighting>& seen = sightings[take_label(rows, forest)];
    EntitySighting sighting{rows.integer<std::uint32_t>()};
    sighting.entity = rows.integer<std::uint16_t>();
    const auto rated = ratings.find({sighting.frame, sighting.entity});
    if (rated != ratings.end()) sighting.rating = rated->second;
    seen.push_back(sighting);
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

std::map<Label, std::int64_t> read_last_frames(SQLite::Database& database) {
  std::map<Label, std::int64_t> last;
  RowReader rows(database, kSuperPointFrames);
  while (rows.next()) {
    const auto label = rows.integer<Label>();
    rows.integer<std::int64_t>();  // the first
    last[label] = rows.integer<std::int64_t>();
    rows.skip();
  }
  return last;
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
