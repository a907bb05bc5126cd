// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_file/map_file_guard.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <utility>

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include "ovimap/base/error.h"
#include "ovimap/io/map_tables/map_file_rows.h"

namespace ovimap {

namespace {

namespace fs = std::filesystem;

/// Far above what the statements and tables of this program take.
constexpr std::pair<int, int> kLimits[] = {
    {SQLITE_LIMIT_SQL_LENGTH, 100000},   {SQLITE_LIMIT_COLUMN, 100},
    {SQLITE_LIMIT_EXPR_DEPTH, 20},       {SQLITE_LIMIT_COMPOUND_SELECT, 3},
    {SQLITE_LIMIT_VDBE_OP, 100000},      {SQLITE_LIMIT_FUNCTION_ARG, 8},
    {SQLITE_LIMIT_ATTACHED, 0},          {SQLITE_LIMIT_LIKE_PATTERN_LENGTH, 50},
    {SQLITE_LIMIT_VARIABLE_NUMBER, 100}, {SQLITE_LIMIT_TRIGGER_DEPTH, 1},
    {SQLITE_LIMIT_WORKER_THREADS, 0}};

constexpr std::pair<int, int> kSwitches[] = {{SQLITE_DBCONFIG_DEFENSIVE, 1},
                                             {SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
                                             {SQLITE_DBCONFIG_ENABLE_TRIGGER, 0},
                                             {SQLITE_DBCONFIG_ENABLE_VIEW, 0}};

constexpr std::uint64_t kRoomForStatements = std::uint64_t{1} << 20;

fs::path with_ending(fs::path file, const char* ending) {
  return file += ending;
}

std::uint64_t size_of(const fs::path& file) {
  std::error_code missing;
  const std::uintmax_t size = fs::file_size(file, missing);
  return missing ? 0 : size;
}

std::string definition_of(const MapTable& table) {
  std::string sql = concat("CREATE TABLE ", table.name, " (", table.definition, ")");
  if (*table.options != '\0') sql += concat(" ", table.options);
  return sql;
}

/// A name out of the file, which may be as long as it likes.
std::string short_name(const std::string& name) {
  constexpr std::size_t kShown = 60;
  return concat("'", name.substr(0, kShown), "'");
}

void check_table(SQLite::Database& database, const std::string& name, const std::string& sql,
                 std::int64_t root_page) {
  if (root_page <= 0) throw Error(concat("it holds the virtual table ", short_name(name)));
  for (const MapTable* table : map_tables::kAll)
    if (sqlite3_stricmp(table->name, name.c_str()) == 0) {
      if (sql != definition_of(*table))
        throw Error(concat("table ", table->name, " is not defined as in a map"));
      return;
    }
  SQLite::Statement computed(database, "SELECT 1 FROM pragma_table_xinfo(?) WHERE hidden <> 0");
  computed.bind(1, name);
  if (computed.executeStep())
    throw Error(concat("its table ", short_name(name), " has computed columns"));
}

}  // namespace

std::unique_ptr<SQLite::Database> open_guarded(const std::string& name, int flags,
                                               std::uint64_t longest_value, int patience_ms) {
  auto database =
      std::make_unique<SQLite::Database>(name, flags | SQLite::OPEN_NOMUTEX, patience_ms);
  sqlite3* const handle = database->getHandle();
  sqlite3_limit(handle, SQLITE_LIMIT_LENGTH,
                static_cast<int>(std::min(longest_value, kLongestValue)));
  for (const auto& [limit, value] : kLimits) sqlite3_limit(handle, limit, value);
  for (const auto& [name_of_switch, on] : kSwitches)
    sqlite3_db_config(handle, name_of_switch, on, nullptr);
  database->exec("PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0");
  return database;
}

std::uint64_t longest_value_in(const fs::path& file) {
  return size_of(file) + size_of(with_ending(file, "-wal")) + kRoomForStatements;
}

void check_schema(SQLite::Database& database) {
  SQLite::Statement parts(database, "SELECT type, name, sql, rootpage FROM sqlite_master");
  while (parts.executeStep()) {
    const std::string type = parts.getColumn(0).getString(), name = parts.getColumn(1).getString();
    if (type == "table")
      check_table(database, name, parts.getColumn(2).getString(), parts.getColumn(3).getInt64());
    else if (type != "index" || !parts.getColumn(2).isNull())  // a key's own has no definition
      throw Error(concat("it holds the ", type == "index" || type == "view" ? type : "trigger", " ",
                         short_name(name), ", and a map holds none"));
  }
}

bool has_journal(const fs::path& file) {
  return fs::exists(with_ending(file, "-journal"));
}

bool has_wal(const fs::path& file) {
  return fs::exists(with_ending(file, "-wal"));
}

void check_journal(const fs::path& file) {
  // So ends a journal that names the journal of a change to several files. Taking it back may
  // delete the file of that name.
  constexpr std::array<char, 8> kNamesAnother = {'\xd9', '\xd5', '\x05', '\xf9',
                                                 '\x20', '\xa1', '\x63', '\xd7'};
  std::array<char, 8> end{};
  std::ifstream journal(with_ending(file, "-journal"), std::ios::binary);
  journal.seekg(-static_cast<std::streamoff>(end.size()), std::ios::end);
  journal.read(end.data(), end.size());
  if (journal && end == kNamesAnother)
    throw Error("the -journal beside it is not of a map; delete that, and check the map");
}

}  // namespace ovimap
