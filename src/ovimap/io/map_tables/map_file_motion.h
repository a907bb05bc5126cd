// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/map_tables/map_document.h"

namespace SQLite {
class Database;
}

namespace ovimap {

/// Writes MapRecord::seen_free and MapRecord::movers.
void write_motion(SQLite::Database& database, const MapRecord& record);

/// The way back; nothing for a map that has neither. Throws Error with a phrase when the file does
/// not hold what was written.
void read_motion(SQLite::Database& database, MapRecord& record);

}  // namespace ovimap
