// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/io/map_tables/map_file_meta.h"
#include "ovimap/io/map_tables/map_file_rows.h"

namespace SQLite {
class Database;
}

namespace ovimap {

/// Where objects are described: as mapping found them, and as people corrected them.
struct InstanceTables {
  const MapTable &instances, &super_points, &names, &confidences;
};
inline constexpr InstanceTables kFoundInstanceTables{
    map_tables::kInstances, map_tables::kInstanceSuperPoints, map_tables::kInstanceNames,
    map_tables::kInstanceConfidences};
inline constexpr InstanceTables kCorrectedInstanceTables{
    map_tables::kCorrectedInstances, map_tables::kCorrectedSuperPoints, map_tables::kCorrectedNames,
    map_tables::kCorrectedConfidences};

/// Maps of the first schema know nothing of looks.
inline constexpr int kSchemaWithSemantics = 2;
/// Those before this one tell looks and records by instance, not by super-point.
inline constexpr int kSchemaWithSuperPoints = 5;

/// Writes everything of a map but its blocks and its forest of labels.
void write_record(SQLite::Database& database, const MapRecord& record, const MapMeta& meta);

/// Which labels are merged.
void write_forest(SQLite::Database& database, const LabelForest& forest);
LabelForest read_forest(SQLite::Database& database);

/// The parts of the way back. Each fills its part of `record` and throws Error with a phrase when
/// the file does not hold what was written.
void write_instances(SQLite::Database& database, const MapRecord& record,
                     const InstanceTables& tables);  ///< with their names and confidences
void read_instances(SQLite::Database& database, MapRecord& record, const InstanceTables& tables);
void read_frames(SQLite::Database& database, MapRecord& record);
/// `forest`: the labels that the state may speak of.
void read_registry(SQLite::Database& database, int schema, const LabelForest& forest,
                   MapRecord& record);

/// Of each super-point the last frame that showed it, as Frame::index: a part of `read_registry`.
std::map<Label, std::int64_t> read_last_frames(SQLite::Database& database);

/// A label that exists, and an instance that was once given out.
Label take_label(RowReader& rows, const LabelForest& forest);
InstanceId take_instance(RowReader& rows, InstanceId last_id);

}  // namespace ovimap
