// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "ovimap/io/map_tables/map_document.h"

namespace SQLite {
class Database;
}

namespace ovimap {

/// Writes what is known of the objects' parts: where they are, and what each looks like by its
/// super-points' views. A map without parts has no such tables.
void write_object_parts(SQLite::Database& database, const MapRecord& record);

/// The way back. Throws Error with a phrase when a part is none: super-points are missing, out of
/// order or not of the map, or its id is not its oldest.
std::vector<ObjectPart> read_object_parts(SQLite::Database& database);
/// The embeddings by part; those that look like nothing have none.
std::map<Label, Eigen::VectorXf> read_part_embeddings(SQLite::Database& database,
                                                      const EncoderIdentity& encoder);

}  // namespace ovimap
