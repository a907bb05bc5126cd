// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include "ovimap/base/error.h"

namespace SQLite {
class Database;
}

namespace ovimap {

/// A map being written: an empty database beside the target, which takes the target's place at
/// commit and disappears when there is none. Throws Error naming the target, the reason and the
/// remedy.
class PendingMap {
 public:
  explicit PendingMap(const std::filesystem::path& target);
  ~PendingMap();
  PendingMap(const PendingMap&) = delete;
  PendingMap& operator=(const PendingMap&) = delete;

  /// Calls `fill` in one transaction.
  void write(const std::function<void(SQLite::Database&)>& fill);
  /// Waits until the file is on disk and renames it.
  void commit();

 private:
  std::filesystem::path target_, temporary_;
};

/// The file is a map, or was one, but its content is not what was written.
class DamagedMap : public Error {
 public:
  using Error::Error;
};

/// Calls `read`; what it throws about the content becomes "map 'x' is damaged: ...".
void read_as_map(const std::filesystem::path& path, SQLite::Database& database,
                 const std::function<void(SQLite::Database&)>& read);

/// Creates a map file that grows in place, or opens it to go on, for this program alone. Every
/// transaction is on disk when it is committed, and whole or not there at all whatever happens.
/// SQLite's exceptions pass through; throws Error when the file is in use.
std::unique_ptr<SQLite::Database> open_growing_map(const std::filesystem::path& path);

/// Ends the name of a checkpoint. What lies beside such a file belongs to it and is read with it.
inline constexpr const char* kCheckpointEnding = ".partial";

/// Makes a map whole beside which a change that was cut short left SQLite's log: an unfinished
/// change is taken back, a finished one taken in. Returns whether there was a log. Throws Error
/// when the file is no map, in use, or cannot be written.
bool recover_map(const std::filesystem::path& path);

/// Deletes a map file and SQLite's files beside it.
void remove_map(const std::filesystem::path& path);

/// Calls `write`; SQLite's exceptions become an Error that names the file, the reason and the
/// remedy. `database` may be null.
void reporting_write_faults(const std::filesystem::path& path, const SQLite::Database* database,
                            const std::function<void()>& write);

/// An existing map, opened for reading only; also from folders and media that cannot be written.
/// Throws Error when there is none, it is no ovimap map of a schema this program knows, or a log
/// lies beside it that nobody is writing: recover_map makes such a map whole.
class OpenMap {
 public:
  explicit OpenMap(const std::filesystem::path& path);
  ~OpenMap();

  int schema() const { return schema_; }
  std::uint64_t size_bytes() const { return size_bytes_; }

  /// Calls `read`; what it throws about the content becomes "map 'x' is damaged: ...".
  void read(const std::function<void(SQLite::Database&)>& read);

 private:
  std::filesystem::path path_;
  std::unique_ptr<SQLite::Database> database_;
  int schema_ = 0;
  std::uint64_t size_bytes_ = 0;
};

}  // namespace ovimap
