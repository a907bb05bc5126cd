// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ovimap/base/error.h"

namespace SQLite {
class Database;
class Statement;
}  // namespace SQLite

namespace ovimap {

/// A table of the map file; docs/map-format.md says what its columns mean.
struct MapTable {
  const char* name;
  const char* columns;  ///< at least two, the primary key first
  const char* definition;
  const char* options = "";
};

namespace map_tables {
inline constexpr MapTable kMeta{"meta", "key, value", "key TEXT PRIMARY KEY, value TEXT NOT NULL",
                                "WITHOUT ROWID"};
inline constexpr MapTable kInstances{"instances",
                                     "id, min_x, min_y, min_z, max_x, max_y, max_z, centroid_x, "
                                     "centroid_y, centroid_z, points, views",
                                     "id INTEGER PRIMARY KEY, min_x REAL, min_y REAL, min_z REAL, "
                                     "max_x REAL, max_y REAL, max_z REAL, "
                                     "centroid_x REAL, centroid_y REAL, centroid_z REAL, points "
                                     "INTEGER NOT NULL, views INTEGER NOT NULL"};
inline constexpr MapTable kInstanceSuperPoints{
    "instance_super_points", "instance, label",
    "instance INTEGER NOT NULL, label INTEGER NOT NULL, PRIMARY KEY (instance, label)",
    "WITHOUT ROWID"};
inline constexpr MapTable kInstanceNames{"instance_names", "id, name",
                                         "id INTEGER PRIMARY KEY, name TEXT NOT NULL"};
/// Not in maps whose masks nobody rated.
inline constexpr MapTable kInstanceConfidences{"instance_confidences", "id, confidence",
                                               "id INTEGER PRIMARY KEY, confidence REAL NOT NULL"};
inline constexpr MapTable kInstanceAliases{"instance_aliases", "id, target",
                                           "id INTEGER PRIMARY KEY, target INTEGER NOT NULL"};
inline constexpr MapTable kSuperPoints{"super_points", "label, frames_seen",
                                       "label INTEGER PRIMARY KEY, frames_seen INTEGER NOT NULL"};
inline constexpr MapTable kSuperPointFrames{
    "super_point_frames", "label, first_frame, last_frame, runs",
    "label INTEGER PRIMARY KEY, first_frame INTEGER NOT NULL, last_frame INTEGER NOT NULL, runs "
    "BLOB NOT NULL"};
inline constexpr MapTable kVotes{"votes", "label, instance, votes",
                                 "label INTEGER NOT NULL, instance INTEGER NOT NULL, votes INTEGER "
                                 "NOT NULL, PRIMARY KEY (label, instance)",
                                 "WITHOUT ROWID"};
inline constexpr MapTable kLabelPairs{"label_pairs", "lower, higher, joined, apart",
                                      "lower INTEGER NOT NULL, higher INTEGER NOT NULL, joined "
                                      "INTEGER NOT NULL, apart INTEGER NOT NULL, "
                                      "PRIMARY KEY (lower, higher)",
                                      "WITHOUT ROWID"};
inline constexpr MapTable kEntitySightings{
    "entity_sightings", "label, frame, entity",
    "label INTEGER NOT NULL, frame INTEGER NOT NULL, entity INTEGER NOT NULL, "
    "PRIMARY KEY (label, frame)",
    "WITHOUT ROWID"};
/// How good its source rated the mask of an entity, of 255; not in maps whose masks are all taken
/// for true.
inline constexpr MapTable kEntityRatings{
    "entity_ratings", "frame, entity, rating",
    "frame INTEGER NOT NULL, entity INTEGER NOT NULL, rating INTEGER NOT NULL, "
    "PRIMARY KEY (frame, entity)",
    "WITHOUT ROWID"};
inline constexpr MapTable kLabelForest{"label_forest", "epoch, roots",
                                       "epoch INTEGER PRIMARY KEY, roots BLOB NOT NULL"};
inline constexpr MapTable kFrames{
    "frames", "position, source_index, timestamp_s, name, world_from_camera, labelled",
    "position INTEGER PRIMARY KEY, source_index INTEGER NOT NULL, timestamp_s REAL, name TEXT NOT "
    "NULL, "
    "world_from_camera BLOB NOT NULL, labelled INTEGER NOT NULL"};
inline constexpr MapTable kSuperPointLooks{
    "super_point_looks",
    "label, seen_min_x, seen_min_y, seen_min_z, seen_max_x, seen_max_y, seen_max_z, offered, "
    "queries",
    "label INTEGER PRIMARY KEY, seen_min_x REAL, seen_min_y REAL, seen_min_z REAL, seen_max_x "
    "REAL, seen_max_y REAL, seen_max_z REAL, offered INTEGER NOT NULL, queries INTEGER NOT NULL"};
inline constexpr MapTable kSuperPointViews{
    "super_point_views",
    "label, frame, visible_px, center_x, center_y, center_z, bins, embedding, crop_jpeg, "
    "crop_mask_png, min_x, min_y, max_x, max_y",
    "label INTEGER NOT NULL, frame INTEGER NOT NULL, visible_px INTEGER NOT NULL, center_x REAL, "
    "center_y REAL, center_z REAL, bins BLOB NOT NULL, embedding BLOB NOT NULL, crop_jpeg BLOB NOT "
    "NULL, crop_mask_png BLOB NOT NULL, min_x INTEGER NOT NULL, min_y INTEGER NOT NULL, max_x "
    "INTEGER NOT NULL, max_y INTEGER NOT NULL, PRIMARY KEY (label, frame)"};
/// Read in the views' crops; not in maps in which nothing was read.
inline constexpr MapTable kWriting{
    "writing", "label, frame, line, text, confidence, min_x, min_y, max_x, max_y",
    "label INTEGER NOT NULL, frame INTEGER NOT NULL, line INTEGER NOT NULL, text TEXT NOT NULL, "
    "confidence REAL NOT NULL, min_x INTEGER NOT NULL, min_y INTEGER NOT NULL, max_x INTEGER NOT "
    "NULL, max_y INTEGER NOT NULL, PRIMARY KEY (label, frame, line)"};
/// What a recognizer tells, and what it found in the views; not in maps made without one.
inline constexpr MapTable kThings{"things", "position, words",
                                  "position INTEGER PRIMARY KEY, words TEXT NOT NULL"};
inline constexpr MapTable kRecognized{
    "recognized", "label, frame, log_ratios",
    "label INTEGER NOT NULL, frame INTEGER NOT NULL, log_ratios BLOB NOT NULL, "
    "PRIMARY KEY (label, frame)"};
inline constexpr MapTable kEmbeddings{"embeddings", "instance, embedding",
                                      "instance INTEGER PRIMARY KEY, embedding BLOB NOT NULL"};
inline constexpr MapTable kSurfaces{"surfaces", "instance, points",
                                    "instance INTEGER PRIMARY KEY, points BLOB NOT NULL"};
/// What surfaces measure, so that most questions need not read them; not in maps of older programs.
inline constexpr MapTable kObjectShapes{
    "object_shapes",
    "instance, bottom, top, centroid_x, centroid_y, centroid_z, footprint, height, length, depth, "
    "above_floor, top_share, covered_share",
    "instance INTEGER PRIMARY KEY, bottom REAL, top REAL, centroid_x REAL, centroid_y REAL, "
    "centroid_z REAL, footprint BLOB NOT NULL, height REAL, length REAL, depth REAL, above_floor "
    "REAL, top_share REAL, covered_share REAL"};
inline constexpr MapTable kBlocks{"blocks", "tile, present, hash, data",
                                  "tile INTEGER PRIMARY KEY, present INTEGER NOT NULL, hash "
                                  "INTEGER NOT NULL, data BLOB NOT NULL"};
inline constexpr MapTable kKeptFrames{
    "kept_frames", "position, depth, color, segments, labels",
    "position INTEGER PRIMARY KEY, depth BLOB NOT NULL, color BLOB NOT NULL, segments BLOB NOT "
    "NULL, labels BLOB NOT NULL"};
/// Parts of objects, by their oldest super-point; not in maps in which no object has any.
inline constexpr MapTable kObjectParts{
    "object_parts",
    "id, super_points, min_x, min_y, min_z, max_x, max_y, max_z, centroid_x, centroid_y, "
    "centroid_z, points, views",
    "id INTEGER PRIMARY KEY, super_points BLOB NOT NULL, min_x REAL, min_y REAL, min_z REAL, max_x "
    "REAL, max_y REAL, max_z REAL, centroid_x REAL, centroid_y REAL, centroid_z REAL, points "
    "INTEGER NOT NULL, views INTEGER NOT NULL"};
inline constexpr MapTable kPartEmbeddings{"part_embeddings", "part, embedding",
                                          "part INTEGER PRIMARY KEY, embedding BLOB NOT NULL"};
/// What maps before schema 5 have: records and looks by instance.
inline constexpr MapTable kInstanceRecords{
    "instance_records", "id, views, first_frame, last_frame",
    "id INTEGER PRIMARY KEY, views INTEGER NOT NULL, first_frame INTEGER NOT NULL, last_frame "
    "INTEGER NOT NULL"};
inline constexpr MapTable kAppearances{
    "appearances",
    "instance, center_x, center_y, center_z, seen_min_x, seen_min_y, seen_min_z, seen_max_x, "
    "seen_max_y, seen_max_z, bins, largest_px, offered, queries",
    "instance INTEGER PRIMARY KEY, center_x REAL, center_y REAL, center_z REAL, seen_min_x REAL, "
    "seen_min_y REAL, seen_min_z REAL, seen_max_x REAL, seen_max_y REAL, seen_max_z REAL, bins "
    "BLOB NOT NULL, largest_px INTEGER NOT NULL, offered INTEGER NOT NULL, queries INTEGER NOT "
    "NULL"};
inline constexpr MapTable kViews{
    "views",
    "instance, ordinal, frame, visible_px, embedding, crop_jpeg, crop_mask_png, min_x, min_y, "
    "max_x, max_y",
    "instance INTEGER NOT NULL, ordinal INTEGER NOT NULL, frame INTEGER NOT NULL, visible_px "
    "INTEGER NOT NULL, embedding BLOB NOT NULL, crop_jpeg BLOB NOT NULL, crop_mask_png BLOB NOT "
    "NULL, min_x INTEGER NOT NULL, min_y INTEGER NOT NULL, max_x INTEGER NOT NULL, max_y INTEGER "
    "NOT NULL, PRIMARY KEY (instance, ordinal)"};
/// What the recordings of a map were, and what each changed.
inline constexpr MapTable kVisits{
    "visits", "visit, source, first_frame, first_index",
    "visit INTEGER PRIMARY KEY, source TEXT NOT NULL, first_frame INTEGER NOT NULL, first_index "
    "INTEGER NOT NULL"};
/// When recordings were made, as people said; not in maps of which nobody did.
inline constexpr MapTable kVisitTimes{"visit_times", "visit, recorded_s",
                                      "visit INTEGER PRIMARY KEY, recorded_s REAL"};
inline constexpr MapTable kObjectEvents{
    "object_events", "id, instance, kind, visit, frame, before, after, may_be",
    "id INTEGER PRIMARY KEY, instance INTEGER NOT NULL, kind TEXT NOT NULL, visit INTEGER NOT "
    "NULL, frame INTEGER NOT NULL, before BLOB NOT NULL, after BLOB NOT NULL, may_be INTEGER NOT "
    "NULL"};
/// Objects as they were before such an event; not in maps in which nothing left its place.
inline constexpr MapTable kPastObjects{
    "past_objects",
    "event, centroid_x, centroid_y, centroid_z, points, views, super_points, surface, colors",
    "event INTEGER PRIMARY KEY, centroid_x REAL, centroid_y REAL, centroid_z REAL, points INTEGER "
    "NOT NULL, views INTEGER NOT NULL, super_points BLOB NOT NULL, surface BLOB NOT NULL, colors "
    "BLOB NOT NULL"};
/// Space that frames of the last visit looked through, by cubes of 8 x 8 x 8 blocks, and what moved
/// while it was seen; not in maps of which nobody asked.
inline constexpr MapTable kSeenFree{"seen_free", "region, cells",
                                    "region INTEGER PRIMARY KEY, cells BLOB NOT NULL"};
/// Of its blocks, those whose surface was first seen beside something that moved.
inline constexpr MapTable kSuspectSpace{"suspect_space", "region, cells",
                                        "region INTEGER PRIMARY KEY, cells BLOB NOT NULL"};
inline constexpr MapTable kMovers{
    "movers", "id, size_x, size_y, size_z, path",
    "id INTEGER PRIMARY KEY, size_x REAL, size_y REAL, size_z REAL, path BLOB NOT NULL"};
/// What a live run did, step by step; not in maps of other runs.
inline constexpr MapTable kLiveSteps{
    "live_steps", "step, kind, frame, asked, looked",
    "step INTEGER PRIMARY KEY, kind INTEGER NOT NULL, frame INTEGER NOT NULL, asked INTEGER NOT "
    "NULL, looked INTEGER NOT NULL"};
/// The log of corrections, and what it makes of the tables above.
inline constexpr MapTable kEdits{"edits", "id, time_s, action, arguments, undone_by",
                                 "id INTEGER PRIMARY KEY, time_s REAL, action TEXT NOT NULL, "
                                 "arguments TEXT NOT NULL, undone_by INTEGER NOT NULL"};
inline constexpr MapTable kCorrectedInstances{"corrected_instances", kInstances.columns,
                                              kInstances.definition};
inline constexpr MapTable kCorrectedSuperPoints{
    "corrected_super_points", kInstanceSuperPoints.columns, kInstanceSuperPoints.definition,
    kInstanceSuperPoints.options};
inline constexpr MapTable kCorrectedNames{"corrected_names", kInstanceNames.columns,
                                          kInstanceNames.definition};
inline constexpr MapTable kCorrectedConfidences{
    "corrected_confidences", kInstanceConfidences.columns, kInstanceConfidences.definition};
inline constexpr MapTable kCorrectedSurfaces{"corrected_surfaces", kSurfaces.columns,
                                             kSurfaces.definition};
inline constexpr MapTable kCorrectedShapes{"corrected_shapes", kObjectShapes.columns,
                                           kObjectShapes.definition};
inline constexpr MapTable kCorrectedEmbeddings{"corrected_embeddings", kEmbeddings.columns,
                                               kEmbeddings.definition};
inline constexpr MapTable kCorrectedFlags{
    "corrected_flags", "id, hidden, locked",
    "id INTEGER PRIMARY KEY, hidden INTEGER NOT NULL, locked INTEGER NOT NULL"};
/// Number of rows and hash of every other table; filled by RowWriter, read by RowReader.
inline constexpr MapTable kChecks{
    "checks", "name, rows, hash",
    "name TEXT PRIMARY KEY, rows INTEGER NOT NULL, hash INTEGER NOT NULL", "WITHOUT ROWID"};
/// All of them.
inline constexpr const MapTable* kAll[] = {&kMeta,
                                           &kInstances,
                                           &kInstanceSuperPoints,
                                           &kInstanceNames,
                                           &kInstanceConfidences,
                                           &kInstanceAliases,
                                           &kSuperPoints,
                                           &kSuperPointFrames,
                                           &kVotes,
                                           &kLabelPairs,
                                           &kEntitySightings,
                                           &kEntityRatings,
                                           &kLabelForest,
                                           &kFrames,
                                           &kSuperPointLooks,
                                           &kSuperPointViews,
                                           &kWriting,
                                           &kThings,
                                           &kRecognized,
                                           &kEmbeddings,
                                           &kSurfaces,
                                           &kObjectShapes,
                                           &kObjectParts,
                                           &kPartEmbeddings,
                                           &kBlocks,
                                           &kKeptFrames,
                                           &kInstanceRecords,
                                           &kAppearances,
                                           &kViews,
                                           &kVisits,
                                           &kVisitTimes,
                                           &kObjectEvents,
                                           &kPastObjects,
                                           &kSeenFree,
                                           &kSuspectSpace,
                                           &kMovers,
                                           &kLiveSteps,
                                           &kEdits,
                                           &kCorrectedInstances,
                                           &kCorrectedSuperPoints,
                                           &kCorrectedNames,
                                           &kCorrectedConfidences,
                                           &kCorrectedSurfaces,
                                           &kCorrectedShapes,
                                           &kCorrectedEmbeddings,
                                           &kCorrectedFlags,
                                           &kChecks};
}  // namespace map_tables

/// XXH64 with seed 0, as SQLite can hold it.
std::int64_t stored_hash(std::span<const std::uint8_t> bytes);

/// The hash of a table is the sum of its rows' hashes, so the order of rows does not matter and a
/// row can be replaced without reading the others. A row is hashed as its values, each led by its
/// type.
class TableHash {
 public:
  void add(std::int64_t value);
  void add(double value);  ///< NaN counts as absent and -0 as 0: SQLite keeps neither
  void add(std::string_view value);
  void add(std::span<const std::uint8_t> value);
  void end_row();

  std::int64_t rows() const { return rows_; }
  std::int64_t sum() const { return static_cast<std::int64_t>(sum_); }

 private:
  void add_bytes(char type, const void* data, std::size_t size);
  void add_word(char type, std::uint64_t word);

  std::vector<std::uint8_t> row_;
  std::int64_t rows_ = 0;
  std::uint64_t sum_ = 0;
};

/// Leaves a table that is there as it is.
void create_table(SQLite::Database& database, const MapTable& table);

bool has_table(SQLite::Database& database, const MapTable& table);

/// The same of a table that not every map has. Throws Error with a phrase when there was one, as
/// its check says.
bool holds_table(SQLite::Database& database, const MapTable& table);

/// Throws Error with a phrase unless the table's rows are those that were written, whatever they
/// mean.
void verify_table(SQLite::Database& database, const MapTable& table);

/// Removes a table and its check, if it is there.
void drop_table(SQLite::Database& database, const MapTable& table);

/// Writes the check of a table whose rows were written by hand.
void write_check(SQLite::Database& database, const MapTable& table, std::int64_t rows,
                 std::int64_t hash);

/// Creates a table and inserts rows into it. SQLite's exceptions pass through.
class RowWriter {
 public:
  RowWriter(SQLite::Database& database, const MapTable& table);
  ~RowWriter();

  /// One value per column: integers, floats or doubles, text, or a span of bytes.
  template <class... Values>
  void insert(const Values&... values) {
    (bind(values), ...);
    end_row();
  }
  /// Writes the table's check. Without it the table cannot be read.
  void finish();
  /// Of the rows so far.
  std::uint64_t sum() const { return static_cast<std::uint64_t>(hash_.sum()); }

 private:
  template <class Integer>
  requires std::is_integral_v<Integer>
  void bind(Integer value) { bind_integer(static_cast<std::int64_t>(value)); }
  void bind(float value) { bind_real(value); }
  void bind(double value) { bind_real(value); }
  void bind(const std::string& value);
  void bind(std::span<const std::uint8_t> value);
  void bind_integer(std::int64_t value);
  void bind_real(double value);
  void end_row();

  SQLite::Database& database_;
  const MapTable& table_;
  std::unique_ptr<SQLite::Statement> statement_;
  TableHash hash_;
  int column_ = 0;
};

/// Reads a table in the order of its primary key. Throws Error with a phrase ("table votes ...")
/// when the table is not what was written; SQLite's exceptions pass through.
class RowReader {
 public:
  RowReader(SQLite::Database& database, const MapTable& table);
  ~RowReader();

  /// Goes to the next row. At the end, verifies the table's check and returns false.
  bool next();

  /// The values of the row, one call per column in their order.
  template <class Integer>
  Integer integer() {
    const std::int64_t value = integer_value();
    if (!std::in_range<Integer>(value)) fail(concat("holds ", value, " out of range"));
    return static_cast<Integer>(value);
  }
  double real();
  std::string text();
  void skip();                           ///< the rest of the row, whatever it holds
  std::span<const std::uint8_t> blob();  ///< valid until the next call of next()

  [[noreturn]] void fail(const std::string& fault) const;

 private:
  std::int64_t integer_value();
  int take_column(int type);
  void verify();

  SQLite::Database& database_;
  const MapTable& table_;
  std::unique_ptr<SQLite::Statement> statement_;
  TableHash hash_;
  int column_ = -1;
};

}  // namespace ovimap
