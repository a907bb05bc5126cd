// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_file/map_check.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include "ovimap/image/codec.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/map_file/map_file_fixture.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

class MapChecking : public MapFolder {
 protected:
  MapChecking() { save_map(path_, saved_); }

  std::string faults() const {
    std::string all;
    for (const std::string& fault : check_map(path_).faults) all += fault + "\n";
    return all;
  }
  std::string faults_after(const std::string& sql) const {
    save_map(path_, saved_);
    SQLite::Database(path_.string(), SQLite::OPEN_READWRITE).exec(sql);
    return faults();
  }

  const MapDocument saved_ = random_document(200, 20);
  const fs::path path_ = root_ / "a.ovimap";
};

TEST_F(MapChecking, AWholeMapHasNoFault) {
  const MapCheck check = check_map(path_);
  EXPECT_TRUE(check.faults.empty()) << faults();
  EXPECT_EQ(check.blocks, saved_.map.block_count());
  EXPECT_GT(check.tiles, 5u);
  EXPECT_EQ(check.tables, 34u);
  MapEdit rename;
  rename.instances = {1};
  rename.name = "cup";
  edit_map(path_, rename);
  EXPECT_EQ(faults(), "");
  EXPECT_EQ(check_map(path_).tables, 43u);
}

TEST_F(MapChecking, TablesThatDifferAreNamed) {
  const fs::path other = root_ / "b.ovimap";
  MapRecord changed = saved_;
  changed.timings = "fuse 1 2 3";  // in `meta`
  save_map(other, saved_.map, changed);
  EXPECT_TRUE(differing_tables(path_, other).empty());
  changed.live_steps.front().asked = false;
  changed.movers.clear();
  save_map(other, saved_.map, changed);
  EXPECT_EQ(differing_tables(path_, other), (std::vector<std::string>{"live_steps", "movers"}));
  EXPECT_EQ(differing_tables(other, path_), differing_tables(path_, other));
}

TEST_F(MapChecking, OldMapsAreWhole) {
  for (const char* name : {"schema1.ovimap", "schema2.ovimap", "schema3.ovimap", "schema4.ovimap",
                           "schema4_embed.ovimap", "schema5.ovimap", "schema6.ovimap"})
    EXPECT_TRUE(check_map(fs::path(OVIMAP_SOURCE_DIR) / "tests/maps" / name).faults.empty())
        << name;
}

TEST_F(MapChecking, EveryDamageIsListed) {
  const std::string both = faults_after(
      "UPDATE votes SET votes = 6 WHERE votes = 5; UPDATE blocks SET data = x'00' WHERE tile = "
      "(SELECT min(tile) FROM blocks); UPDATE blocks SET data = x'00' WHERE tile = (SELECT "
      "max(tile) "
      "FROM blocks); DROP TABLE frames");
  for (const char* what : {"table votes is not what was written", "table frames is missing"})
    EXPECT_NE(both.find(what), std::string::npos) << both;
  std::size_t tiles = 0;
  for (std::size_t at = both.find("tile "); at != std::string::npos;
       at = both.find("tile ", at + 1))
    ++tiles;
  EXPECT_EQ(tiles, 2u) << both;
  EXPECT_NE(faults_after("DELETE FROM blocks WHERE tile = (SELECT max(tile) FROM blocks)")
                .find("were written"),
            std::string::npos);
}

TEST_F(MapChecking, ChangesNothing) {
  Bytes bytes = read_file(path_);
  bytes[bytes.size() / 2] ^= 0x55;
  write_file(path_, bytes);
  EXPECT_NE(faults(), "");
  EXPECT_EQ(read_file(path_), bytes);
  EXPECT_EQ(files_in_root(), 1u);
}

TEST_F(MapChecking, WhatIsNoMapIsRefused) {
  write_file(path_, Bytes(100, 'x'));
  EXPECT_NE(fault_of([&] { check_map(path_); }).find("is not an ovimap map"), std::string::npos);
}

}  // namespace
}  // namespace ovimap
