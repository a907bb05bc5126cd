// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "ovimap/io/map_tables/map_document.h"

namespace SQLite {
class Database;
}

namespace ovimap {

/// What the table `meta` holds besides the fields of MapRecord.
struct MapMeta {
  VoxelMapConfig map_config;
  std::int64_t frames = 0;
  std::uint64_t blocks = 0;
  std::uint64_t content_hash = 0;  ///< 0 when unfinished
  bool unfinished = false;         ///< as in MapRecord
};

void write_meta(SQLite::Database& database, const MapRecord& record, const MapMeta& meta);
/// Fills the plain values of `record`. Throws Error with a phrase when the file does not hold what
/// was written.
MapMeta read_meta(SQLite::Database& database, MapRecord& record);

/// 16 hexadecimal digits.
std::string hash_text(std::uint64_t hash);

}  // namespace ovimap
