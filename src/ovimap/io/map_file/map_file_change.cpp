// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_file/map_file_change.h"

#include <cerrno>
#include <optional>
#include <system_error>
#include <utility>

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include "ovimap/base/error.h"
#include "ovimap/io/map_file/map_file_access.h"
#include "ovimap/io/map_file/map_file_guard.h"

namespace ovimap {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw Error(concat("cannot change map '", path.string(), "': ", why));
}

/// A file that is a link is changed where it is: its journal must lie beside it.
std::filesystem::path changeable(const std::filesystem::path& path) {
  const std::filesystem::path target = std::filesystem::canonical(path);
  if (::access(target.c_str(), W_OK) != 0 || ::access(target.parent_path().c_str(), W_OK) != 0)
    refuse(path, std::generic_category().message(errno) +
                     "; copy it into a folder that you can write to");
  if (has_wal(target)) refuse(path, "it is being mapped; try again when that is done");
  return target;
}

using FileNumber = std::pair<dev_t, ino_t>;

std::optional<FileNumber> number_of(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return FileNumber(status.st_dev, status.st_ino);
}

}  // namespace

MapChange::MapChange(const std::filesystem::path& path, int patience_ms) : path_(path) {
  constexpr int kMostReplacements = 5;
  for (int tries = 0; tries < kMostReplacements; ++tries) {
    schema_ = OpenMap(path).schema();
    const std::filesystem::path target = changeable(path);
    const std::optional<FileNumber> opened = number_of(target);
    begin(target, patience_ms);
    if (opened && number_of(target) == opened) return;
  }
  refuse(path, "it is replaced again and again; try again when that is done");
}

void MapChange::begin(const std::filesystem::path& target, int patience_ms) {
  transaction_.reset();
  guarded([&] {
    database_ = open_guarded(target.string(), SQLite::OPEN_READWRITE, kLongestValue, patience_ms);
    database_->exec("PRAGMA journal_mode = DELETE; PRAGMA synchronous = EXTRA");
    transaction_ =
        std::make_unique<SQLite::Transaction>(*database_, SQLite::TransactionBehavior::IMMEDIATE);
  });
}

MapChange::~MapChange() = default;

void MapChange::read(const std::function<void(SQLite::Database&)>& read) {
  read_as_map(path_, *database_, [&](SQLite::Database& database) {
    check_schema(database);
    read(database);
  });
}

void MapChange::write(const std::function<void(SQLite::Database&)>& write) {
  guarded([&] { write(*database_); });
}

void MapChange::commit() {
  guarded([&] { transaction_->commit(); });
}

void MapChange::guarded(const std::function<void()>& work) {
  try {
    work();
  } catch (const SQLite::Exception& fault) {
    switch (fault.getErrorCode()) {
      case SQLITE_BUSY:
      case SQLITE_LOCKED:
        refuse(path_, "another program is using it; try again when that is done");
      case SQLITE_FULL:
        refuse(path_, "the disk is full; free some space and try again");
      case SQLITE_READONLY:
      case SQLITE_CANTOPEN:
      case SQLITE_IOERR:
        refuse(path_, concat(fault.what(), "; copy it into a folder that you can write to"));
      default:
        refuse(path_, concat(fault.what(), "; `ovimap info --check` tells whether it is damaged"));
    }
  }
}

}  // namespace ovimap
