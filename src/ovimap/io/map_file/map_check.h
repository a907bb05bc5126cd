// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace ovimap {

/// What an examination of a map file found.
struct MapCheck {
  std::vector<std::string> faults;  ///< a line each: what is damaged; empty: nothing is
  std::size_t tables = 0, tiles = 0, blocks = 0;  ///< examined
};

/// Examines every part of a map by itself, where load_map stops at the first fault: SQLite's own
/// check of the file, the hash of each table and of each tile of voxels, each tile's content, and
/// whether it all fits together. Changes nothing. Throws Error when the file is missing or no map
/// at all, as load_map does.
MapCheck check_map(const std::filesystem::path& path);

/// The tables in which two maps differ, by their stored hashes, in order; none: they are the same
/// map. The table `meta`, with when and by which version it was made, does not count. Throws Error
/// as check_map does.
std::vector<std::string> differing_tables(const std::filesystem::path& a,
                                          const std::filesystem::path& b);

}  // namespace ovimap
