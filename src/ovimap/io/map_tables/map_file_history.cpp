// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_tables/map_file_history.h"

#include <algorithm>
#include <array>

#include <SQLiteCpp/SQLiteCpp.h>

#include "ovimap/io/map_tables/map_file_record.h"
#include "ovimap/io/map_tables/map_file_rows.h"
#include "ovimap/io/map_tables/row_words.h"

namespace ovimap {

namespace {

using map_tables::kObjectEvents;
using map_tables::kVisits;

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
    visit.source = rows.text();
    visit.first_frame =
        take_within(rows, visits.empty() ? 0 : visits.back().first_frame, frames);
    visit.first_index = rows.integer<std::int64_t>();
    visits.push_back(std::move(visit));
  }
  return visits;
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
  RowWriter events(database, kObjectEvents);
  number = 0;
  for (const ObjectEvent& event : history.events) {
    const Bytes before = box_bytes(event.before), after = box_bytes(event.after);
    events.insert(++number, event.instance, std::string(event_name(event.kind)), event.visit,
                  event.frame, std::span<const std::uint8_t>(before),
                  std::span<const std::uint8_t>(after), event.may_be);
  }
  events.finish();
}

MapHistory read_history(SQLite::Database& database, int schema, std::int64_t frames,
                        InstanceId last_id) {
  MapHistory history;
  if (schema < kSchemaWithHistory) return history;
  history.visits = read_visits(database, frames);
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

}  // namespace ovimap
