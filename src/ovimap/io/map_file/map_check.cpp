// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_file/map_check.h"

#include <bit>
#include <functional>
#include <map>
#include <set>

#include <SQLiteCpp/SQLiteCpp.h>

#include "ovimap/io/map_file/map_file_access.h"
#include "ovimap/io/map_file/map_file_parts.h"
#include "ovimap/io/map_tables/map_file_blocks.h"
#include "ovimap/io/map_tables/map_file_rows.h"

namespace ovimap {

namespace {

using namespace map_tables;

class MapExaminer {
 public:
  MapExaminer(SQLite::Database& database, int schema) : database_(database), schema_(schema) {}

  MapCheck examine() {
    note("the file", [&] { ask_sqlite(); });
    for (const MapTable* table : kAll)
      if (table != &kChecks) examine_table(*table);
    note("table checks", [&] { find_missing_tables(); });
    note("voxels", [&] { examine_tiles(); });
    return std::move(check_);
  }

 private:
  /// What `work` throws becomes a fault.
  void note(const std::string& what, const std::function<void()>& work) {
    try {
      work();
    } catch (const SQLite::Exception& fault) {
      add(concat(what, ": ", fault.what()));
    } catch (const Error& fault) {
      add(fault.what());
    }
  }

  /// One line a fault, and an end to them.
  void add(std::string fault) {
    constexpr std::size_t kMostFaults = 200;
    if (check_.faults.size() == kMostFaults) check_.faults.emplace_back("and more");
    if (check_.faults.size() > kMostFaults) return;
    for (char& c : fault)
      if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    check_.faults.push_back(std::move(fault));
  }

  void ask_sqlite() {
    SQLite::Statement check(database_, "PRAGMA integrity_check(50)");
    while (check.executeStep())
      if (const std::string line = check.getColumn(0).getString(); line != "ok")
        add("SQLite: " + line);
  }

  void examine_table(const MapTable& table) {
    note(concat("table ", table.name), [&] {
      if (!has_table(database_, table)) return;
      ++check_.tables;
      verify_table(database_, table);
    });
  }

  /// A table of which only the check is left.
  void find_missing_tables() {
    SQLite::Statement names(database_, "SELECT name FROM checks");
    while (names.executeStep())
      if (const std::string name = names.getColumn(0).getString(); !database_.tableExists(name))
        add(concat("table ", name, " is missing"));
    for (const MapTable* table : {&kMeta, &kInstances, &kLabelForest, &kBlocks, &kFrames})
      if (!has_table(database_, *table)) add(concat("table ", table->name, " is missing"));
  }

  void examine_tiles() {
    MapRecord record;
    const MapMeta meta = read_meta(database_, record);
    const LabelForest forest = read_forest(database_);
    SQLite::Statement rows(database_, "SELECT tile, present, hash, data FROM blocks ORDER BY tile");
    const std::size_t faults_before = check_.faults.size();
    while (rows.executeStep()) {
      ++check_.tiles;
      const std::int64_t key = rows.getColumn(0).getInt64();
      const SQLite::Column data = rows.getColumn(3);
      const std::span bytes(static_cast<const std::uint8_t*>(data.getBlob()),
                            static_cast<std::size_t>(data.getBytes()));
      const std::string fault =
          tile_fault(key, static_cast<std::uint64_t>(rows.getColumn(1).getInt64()),
                     rows.getColumn(2).getInt64(), bytes, meta, forest);
      if (!fault.empty()) add(concat("tile ", key, " of the voxels: ", fault));
    }
    if (check_.blocks != meta.blocks)
      add(concat("the voxels have ", check_.blocks, " blocks, but ", meta.blocks, " were written"));
    if (check_.faults.size() != faults_before || check_.blocks != meta.blocks) return;
    (void)read_voxels(database_, schema_, meta, forest);  // the hash of the whole
  }

  std::string tile_fault(std::int64_t key, std::uint64_t present, std::int64_t hash,
                         std::span<const std::uint8_t> data, const MapMeta& meta,
                         const LabelForest& forest) {
    if (!valid_tile_key(static_cast<std::uint64_t>(key))) return "it is out of place";
    check_.blocks += static_cast<std::size_t>(std::popcount(present));
    if (stored_hash(data) != hash) return "it is not what was written";
    VoxelMap map(meta.map_config);
    map.labels() = forest;
    const Tile tile = create_tile(map, static_cast<std::uint64_t>(key), present);
    return decoder_.decode(data, schema_, tile, map);
  }

  SQLite::Database& database_;
  int schema_;
  TileDecoder decoder_;
  MapCheck check_;
};

/// Rows and hash of each table but `meta`, by its name.
using TableChecks = std::map<std::string, std::pair<std::int64_t, std::int64_t>>;

TableChecks read_checks(const std::filesystem::path& path) {
  TableChecks checks;
  OpenMap file(path);
  file.read([&](SQLite::Database& database) {
    SQLite::Statement rows(database, "SELECT name, rows, hash FROM checks WHERE name <> 'meta'");
    while (rows.executeStep())
      checks[rows.getColumn(0).getString()] = {rows.getColumn(1).getInt64(),
                                               rows.getColumn(2).getInt64()};
  });
  return checks;
}

}  // namespace

MapCheck check_map(const std::filesystem::path& path) {
  MapCheck check;
  try {
    OpenMap file(path);
    file.read([&](SQLite::Database& database) {
      check = MapExaminer(database, file.schema()).examine();
    });
  } catch (const DamagedMap& fault) {  // so badly that its tables cannot even be listed
    check.faults.emplace_back(fault.what());
  }
  return check;
}

std::vector<std::string> differing_tables(const std::filesystem::path& a,
                                          const std::filesystem::path& b) {
  const TableChecks of_a = read_checks(a), of_b = read_checks(b);
  std::set<std::string> names;
  for (const TableChecks* checks : {&of_a, &of_b})
    for (const auto& [name, check] : *checks) names.insert(name);
  std::vector<std::string> differing;
  for (const std::string& name : names) {
    const auto in_a = of_a.find(name), in_b = of_b.find(name);
    if (in_a == of_a.end() || in_b == of_b.end() || in_a->second != in_b->second)
      differing.push_back(name);
  }
  return differing;
}

}  // namespace ovimap
