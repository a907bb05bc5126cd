// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace SQLite {
class Database;
}

namespace ovimap {

/// Opens a database of a map, which may be anybody's: `name` is a path or a URI, `flags` are those
/// of SQLite, and no value of it may be longer than `longest_value` bytes. The file's own schema
/// runs no code beyond SQLite's harmless functions, and large numbers in it take no memory. For one
/// thread at a time. SQLite's exceptions pass through.
std::unique_ptr<SQLite::Database> open_guarded(const std::string& name, int flags,
                                               std::uint64_t longest_value, int patience_ms = 0);

/// The most that a value in the file, or in the log beside it, can be long: a file holds no more
/// than its size.
std::uint64_t longest_value_in(const std::filesystem::path& file);
/// For files that this program itself writes: SQLite's own bound.
inline constexpr std::uint64_t kLongestValue = 1000000000;

/// Throws Error with a phrase unless the database consists of plain tables, and those of the map
/// file are defined exactly as this program defines them: a view or a computed column in their
/// place would make reading do work of the file's choosing.
void check_schema(SQLite::Database& database);

/// Whether SQLite's log of a change lies beside the file.
bool has_journal(const std::filesystem::path& file);  ///< to be taken back
bool has_wal(const std::filesystem::path& file);      ///< to be taken in

/// Throws Error with a phrase when taking the file's journal back would touch yet another file: the
/// journals of maps name none.
void check_journal(const std::filesystem::path& file);

}  // namespace ovimap
