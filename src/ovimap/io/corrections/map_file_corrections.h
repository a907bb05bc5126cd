// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/corrections/map_corrections.h"

namespace SQLite {
class Database;
}

namespace ovimap {

/// Writes the log of a map, and beside what mapping found what the log makes of it, so that readers
/// need not know how. Tables of an earlier state are replaced. A map without edits has none of
/// them.
void write_corrections(SQLite::Database& database, const MapRecord& found,
                       const LabelForest& forest, const VoxelSource& voxels);

/// Whether the map has effective edits.
bool has_corrections(SQLite::Database& database);

/// Instances, hidden and locked ones and names as people corrected them.
void read_corrected_instances(SQLite::Database& database, MapRecord& record);

}  // namespace ovimap
