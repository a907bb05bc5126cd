// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <functional>
#include <random>

#include <SQLiteCpp/SQLiteCpp.h>

#include "ovimap/image/codec.h"
#include "ovimap/io/map_file_fixture.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

class MapFileDamage : public MapFolder {
 protected:
  MapFileDamage() { save_map(path_, saved_); }

  /// Loads the bytes as a map. True when that failed with an Error of one line; reports a failure
  /// of the test when the content is other than what was saved.
  bool refused(const Bytes& bytes, const std::string& what) {
    write_file(path_, bytes);
    const auto instances_are_true = [&] {
      EXPECT_TRUE(same_instances(read_map_info(path_).instances, saved_.instances)) << what;
    };
    const std::string info_fault = fault_of(instances_are_true);
    const std::string fault =
        fault_of([&] { EXPECT_EQ(difference(saved_, load_map(path_)), "") << what; });
    EXPECT_EQ(fault.find('\n'), std::string::npos) << what;
    EXPECT_TRUE(info_fault.empty() || !fault.empty()) << what << ": only info says " << info_fault;
    return !fault.empty();
  }

  /// Changes the map as somebody with SQLite at hand would.
  std::string fault_after(const std::string& sql) {
    save_map(path_, saved_);
    SQLite::Database(path_.string(), SQLite::OPEN_READWRITE).exec(sql);
    return fault_of([&] { load_map(path_); });
  }

  const MapDocument saved_ = random_document(6, 20);
  const fs::path path_ = root_ / "a.ovimap";
  std::mt19937 random_{99};
};

TEST_F(MapFileDamage, AFlippedByteIsFoundOrHarmless) {
  const Bytes intact = read_file(path_);
  int refusals = 0;
  constexpr int kTrials = 600;
  for (int trial = 0; trial < kTrials; ++trial) {
    Bytes bytes = intact;
    // A third of the trials hit the first page: header and table definitions.
    const std::size_t at = random_() % (trial % 3 == 0 ? std::size_t{4096} : bytes.size());
    bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1u + random_() % 255));
    refusals += refused(bytes, concat("byte ", at));
  }
  EXPECT_GT(refusals, kTrials / 3);
}

TEST_F(MapFileDamage, AnOverwrittenStretchIsFoundOrHarmless) {
  const Bytes intact = read_file(path_);
  for (int trial = 0; trial < 100; ++trial) {
    Bytes bytes = intact;
    const std::size_t begin = random_() % bytes.size(), length = 1 + random_() % 5000;
    for (std::size_t i = begin; i < std::min(begin + length, bytes.size()); ++i)
      bytes[i] = static_cast<std::uint8_t>(trial % 2 == 0 ? random_() : 0);
    (void)refused(bytes, concat("bytes ", begin, " + ", length));
  }
}

TEST_F(MapFileDamage, ACutFileIsRefused) {
  const Bytes intact = read_file(path_);
  std::vector<std::size_t> lengths = {
      0, 1, 15, 16, 99, 100, 4095, 4096, 8192, intact.size() - 4096, intact.size() - 1};
  for (int i = 0; i < 100; ++i) lengths.push_back(random_() % intact.size());
  for (const std::size_t length : lengths)
    EXPECT_TRUE(refused(Bytes(intact.begin(), intact.begin() + static_cast<std::ptrdiff_t>(length)),
                        concat("cut to ", length)));
}

TEST_F(MapFileDamage, EveryTableIsGuarded) {
  const auto is_damaged = [](const std::string& fault) {
    return fault.find("' is damaged: ") != std::string::npos;
  };
  for (const char* sql : {"UPDATE meta SET value = '0.02' WHERE key = 'map.voxel_size_m'",
                          "UPDATE instances SET points = points + 1",
                          "UPDATE instances SET min_x = 'left'",
                          "DELETE FROM instance_super_points WHERE label = 1",
                          "UPDATE instance_names SET name = 'cup'",
                          "UPDATE instance_records SET views = 4 WHERE id = 1",
                          "UPDATE instance_aliases SET target = 3",
                          "UPDATE super_points SET frames_seen = 99999999999999",
                          "UPDATE votes SET votes = 6 WHERE votes = 5",
                          "UPDATE label_pairs SET apart = 3 WHERE apart = 2",
                          "UPDATE label_forest SET epoch = epoch + 1",
                          "UPDATE label_forest SET roots = substr(roots, 1, 8)",
                          "UPDATE frames SET world_from_camera = x'00'",
                          "DELETE FROM frames WHERE position = 1",
                          "UPDATE blocks SET present = -1",
                          "UPDATE blocks SET tile = tile + 1",
                          "UPDATE blocks SET data = x''",
                          "DELETE FROM blocks WHERE tile = (SELECT max(tile) FROM blocks)",
                          "DELETE FROM checks WHERE name = 'votes'",
                          "DROP TABLE frames",
                          "CREATE VIEW v AS SELECT 1",
                          "PRAGMA user_version = 0",
                          "ALTER TABLE votes RENAME COLUMN votes TO ballots"}) {
    const std::string fault = fault_after(sql);
    EXPECT_TRUE(is_damaged(fault)) << sql << ": " << fault;
  }
  EXPECT_EQ(fault_after("VACUUM"), "");  // rearranging the file is no damage
}

TEST_F(MapFileDamage, SaysWhenItIsNoMap) {
  EXPECT_NE(fault_after("PRAGMA application_id = 7")
                .find("is not an ovimap map but another program's SQLite file"),
            std::string::npos);
  write_file(path_, Bytes(100, 'x'));
  EXPECT_NE(fault_of([&] { load_map(path_); }).find("is not an ovimap map"), std::string::npos);
  write_file(path_, Bytes());
  EXPECT_NE(fault_of([&] { read_map_info(path_); }).find("is not an ovimap map"),
            std::string::npos);
  EXPECT_NE(fault_of([&] { load_map(root_); }).find("is not a file"), std::string::npos);
  EXPECT_NE(fault_of([&] { load_map(root_ / "none"); }).find("No such file"), std::string::npos);
}

TEST_F(MapFileDamage, SaysWhenItIsTooNew) {
  const std::string fault = fault_after("PRAGMA user_version = 7");
  EXPECT_NE(
      fault.find(
          "was written by a newer ovimap (schema 7, this program reads up to 3); update ovimap"),
      std::string::npos)
      << fault;
}

}  // namespace
}  // namespace ovimap
