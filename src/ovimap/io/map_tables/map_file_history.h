// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/map_tables/map_document.h"

namespace SQLite {
class Database;
}

namespace ovimap {

/// Maps before this one are of one visit.
inline constexpr int kSchemaWithHistory = 6;

void write_history(SQLite::Database& database, const MapHistory& history);

/// The way back, but for what objects were; empty for a map of an earlier schema. `frames`,
/// `last_id`: how many frames and the highest instance that it may speak of. Throws Error with a
/// phrase when the file does not hold what was written.
MapHistory read_history(SQLite::Database& database, int schema, std::int64_t frames,
                        InstanceId last_id);

/// What objects were before the events of `history`. Throws likewise.
void read_past_objects(SQLite::Database& database, const LabelForest& forest, MapHistory& history);

/// "appeared", "gone", "moved".
const char* event_name(ObjectEventKind kind);

}  // namespace ovimap
