// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/map_tables/map_document.h"

namespace SQLite {
class Database;
}

namespace ovimap {

/// The frames that a map keeps to be fused again.
void write_kept_frames(SQLite::Database& database, const KeptFrames& frames);

/// The way back. `forest`: the labels that they may speak of. Throws Error with a phrase when the
/// file does not hold what was written.
KeptFrames read_kept_frames(SQLite::Database& database, const LabelForest& forest,
                            std::size_t fused_frames);

/// Brings the table up to date while a map is made: frames come, lose their place to the budget,
/// and get labels late, and all of them are too much to write each time.
class KeptFramesTable {
 public:
  /// Within a transaction.
  void update(SQLite::Database& database, const KeptFrames& frames);

 private:
  struct Row {
    std::shared_ptr<const KeptFrame> frame;
    std::uint64_t hash = 0;
  };
  std::map<std::size_t, Row> rows_;
  bool begun_ = false;
};

/// Writes MapRecord::live_steps.
void write_live_steps(SQLite::Database& database, const std::vector<LiveStep>& steps);

/// The way back; nothing for the map of a run that was not live. Throws Error with a phrase when
/// the file does not hold what was written.
std::vector<LiveStep> read_live_steps(SQLite::Database& database);

}  // namespace ovimap
