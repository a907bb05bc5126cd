// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_tables/map_file_history.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <SQLiteCpp/SQLiteCpp.h>

#include "ovimap/base/text/printable.h"
#include "ovimap/io/map_tables/map_file_record.h"
#include "ovimap/io/map_tables/map_file_rows.h"
#include "ovimap/io/map_tables/map_file_semantics.h"
#include "ovimap/io/map_tables/row_words.h"

namespace ovimap {

namespace {

using map_tables::kObjectEvents;
using map_tables::kPastObjects;
using map_tables::kVisits;
using map_tables::kVisitTimes;

constexpr std::array kEventNames = {"appeared", "gone", "moved"};

/// Nothing for no box.
Bytes box_bytes(const Eigen::AlignedBox3f& box) {
  Bytes bytes;
  if (!box.isEmpty()) append_box(bytes, box);
  return bytes;
}

Eigen::AlignedBox3f take_box(RowReader& rows) {
  const std::span<const std::uint8_t> bytes = rows.blob();
  if (bytes.empty()) return {};
  if (bytes.size() != kBoxBytes) rows.fail(concat("has a box of ", bytes.size(), " bytes"));
  const Eigen::AlignedBox3f box = box_of_words(bytes, rows);
  const bool sound = box.min().allFinite() && box.max().allFinite() && !box.isEmpty();
  if (!sound) rows.fail("has a box that is none");
  return box;
}

ObjectEventKind take_kind(RowReader& rows) {
  const std::string name = rows.text();
  const auto found = std::find(kEventNames.begin(), kEventNames.end(), name);
  if (found == kEventNames.end()) rows.fail(concat("has an event '", name, "'"));
  return static_cast<ObjectEventKind>(found - kEventNames.begin());
}

template <class Integer>
Integer take_within(RowReader& rows, Integer least, Integer most) {
  const auto value = rows.integer<Integer>();
  if (value < least || value > most) rows.fail(concat("holds ", value, " out of range"));
  return value;
}

std::vector<MapVisit> read_visits(SQLite::Database& database, std::int64_t frames) {
  std::vector<MapVisit> visits;
  RowReader rows(database, kVisits);
  while (rows.next()) {
    if (rows.integer<std::size_t>() != visits.size() + 1) rows.fail("has a gap");
    MapVisit visit;
    visit.source = printable(rows.text());
    visit.first_frame = take_within(rows, visits.empty() ? 0 : visits.back().first_frame, frames);
    visit.first_index = rows.integer<std::int64_t>();
    visits.push_back(std::move(visit));
  }
  return visits;
}

void write_visit_times(SQLite::Database& database, const std::vector<MapVisit>& visits) {
  std::optional<RowWriter> rows;  // the table is made for its first row
  for (std::size_t i = 0; i < visits.size(); ++i) {
    if (!visits[i].recorded_s) continue;
    if (!rows) rows.emplace(database, kVisitTimes);
    rows->insert(i + 1, *visits[i].recorded_s);
  }
  if (rows) rows->finish();
}

void read_visit_times(SQLite::Database& database, std::vector<MapVisit>& visits) {
  if (!holds_table(database, kVisitTimes)) return;
  RowReader rows(database, kVisitTimes);
  while (rows.next()) {
    const auto visit = take_within<std::size_t>(rows, 1, visits.size());
    const double recorded_s = rows.real();
    if (!std::isfinite(recorded_s)) rows.fail("has a time that is none");
    visits[visit - 1].recorded_s = recorded_s;
  }
}

void insert_past(RowWriter& rows, std::size_t event, const PastObject& was) {
  Bytes labels, colors;
  for (const Label label : was.super_points) append_word(labels, label);
  for (const auto& color : was.colors) colors.insert(colors.end(), color.begin(), color.end());
  const Bytes surface = surface_bytes(was.surface);
  rows.insert(event, was.centroid.x(), was.centroid.y(), was.centroid.z(), was.points, was.views,
              std::span<const std::uint8_t>(labels), std::span<const std::uint8_t>(surface),
              std::span<const std::uint8_t>(colors));
}

void write_past_objects(SQLite::Database& database, const MapHistory& history) {
  std::optional<RowWriter> rows;  // the table is made for its first row
  for (std::size_t i = 0; i < history.events.size(); ++i) {
    if (!history.events[i].was) continue;
    if (!rows) rows.emplace(database, kPastObjects);
    insert_past(*rows, i + 1, *history.events[i].was);
  }
  if (rows) rows->finish();
}

/// The labels by which those that were written go by now.
std::vector<Label> take_super_points(RowReader& rows, const LabelForest& forest) {
  std::vector<Label> labels = words_of<Label>(rows.blob(), rows);
  for (Label& label : labels) {
    if (label == kNoLabel || label > forest.last_label())
      rows.fail(concat("names label ", label, ", which was never given"));
    label = forest.root(label);
  }
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  return labels;
}

PastObject take_past(RowReader& rows, const LabelForest& forest) {
  PastObject was;
  for (float& coordinate : was.centroid) coordinate = static_cast<float>(rows.real());
  was.points = rows.integer<std::size_t>();
  was.views = rows.integer<int>();
  was.super_points = take_super_points(rows, forest);
  was.surface = take_surface(rows);
  const std::span<const std::uint8_t> colors = rows.blob();
  if (colors.size() != 3 * was.surface.size())
    rows.fail(
        concat("has ", colors.size(), " bytes of colours for ", was.surface.size(), " points"));
  was.colors.resize(was.surface.size());
  for (std::size_t i = 0; i < colors.size(); ++i) was.colors[i / 3][i % 3] = colors[i];
  return was;
}

}  // namespace

const char* event_name(ObjectEventKind kind) {
  return kEventNames[static_cast<std::size_t>(kind)];
}

void write_history(SQLite::Database& database, const MapHistory& history) {
  RowWriter visits(database, kVisits);
  std::size_t number = 0;
  for (const MapVisit& visit : history.visits)
    visits.insert(++number, visit.source, visit.first_frame, visit.first_index);
  visits.finish();
  write_visit_times(database, history.visits);
  RowWriter events(database, kObjectEvents);
  number = 0;
  for (const ObjectEvent& event : history.events) {
    const Bytes before = box_bytes(event.before), after = box_bytes(event.after);
    events.insert(++number, event.instance, std::string(event_name(event.kind)), event.visit,
                  event.frame, std::span<const std::uint8_t>(before),
                  std::span<const std::uint8_t>(after), event.may_be);
  }
  events.finish();
  write_past_objects(database, history);
}

MapHistory read_history(SQLite::Database& database, int schema, std::int64_t frames,
                        InstanceId last_id) {
  MapHistory history;
  if (schema < kSchemaWithHistory) return history;
  history.visits = read_visits(database, frames);
  read_visit_times(database, history.visits);
  RowReader rows(database, kObjectEvents);
  while (rows.next()) {
    if (rows.integer<std::size_t>() != history.events.size() + 1) rows.fail("has a gap");
    ObjectEvent event;
    event.instance = take_instance(rows, last_id);
    event.kind = take_kind(rows);
    event.visit = take_within(rows, 1, static_cast<int>(history.visits.size()));
    event.frame = take_within<std::int64_t>(rows, 0, frames);
    event.before = take_box(rows);
    event.after = take_box(rows);
    event.may_be = take_within<InstanceId>(rows, 0, last_id);
    history.events.push_back(event);
  }
  return history;
}

void read_past_objects(SQLite::Database& database, const LabelForest& forest, MapHistory& history) {
  if (!holds_table(database, kPastObjects)) return;
  RowReader rows(database, kPastObjects);
  while (rows.next()) {
    const auto event = rows.integer<std::size_t>();
    if (event == 0 || event > history.events.size())
      rows.fail(concat("tells of an event ", event, " that is not there"));
    history.events[event - 1].was = std::make_shared<const PastObject>(take_past(rows, forest));
  }
}

}  // namespace ovimap
