// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>

namespace SQLite {
class Database;
class Transaction;
}  // namespace SQLite

namespace ovimap {

/// A saved map being changed in place, in one transaction with a rollback journal: whatever
/// happens, the file holds the old state or the new one. Only one change at a time; readers see the
/// old state until it is complete. A file that another took the place of meanwhile is let go for
/// that one. Throws Error naming the map, the reason and the remedy; what is not committed is
/// undone.
class MapChange {
 public:
  /// Waits that long for readers and other changes to finish.
  explicit MapChange(const std::filesystem::path& path, int patience_ms = 2000);
  ~MapChange();
  MapChange(const MapChange&) = delete;
  MapChange& operator=(const MapChange&) = delete;

  int schema() const { return schema_; }
  /// Calls `read`; what it throws about the content becomes "map 'x' is damaged: ...".
  void read(const std::function<void(SQLite::Database&)>& read);
  void write(const std::function<void(SQLite::Database&)>& write);
  void commit();

 private:
  /// Calls `work` and says in the user's words why SQLite could not.
  void guarded(const std::function<void()>& work);
  void begin(const std::filesystem::path& target, int patience_ms);

  std::filesystem::path path_;
  int schema_ = 0;
  std::unique_ptr<SQLite::Database> database_;
  std::unique_ptr<SQLite::Transaction> transaction_;
};

}  // namespace ovimap
