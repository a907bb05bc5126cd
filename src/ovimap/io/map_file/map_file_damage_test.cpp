// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <fstream>
#include <limits>
#include <random>

#include <SQLiteCpp/SQLiteCpp.h>
#include <sys/resource.h>

#include "ovimap/image/codec.h"
#include "ovimap/io/map_file/map_check.h"
#include "ovimap/io/map_file/map_file_fixture.h"
#include "ovimap/io/map_tables/map_file_rows.h"

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
    const bool any = judge(what);
    EXPECT_TRUE(read_file(path_) == bytes) << what << " changed the file";
    return any;
  }

  bool judge(const std::string& what) {
    const auto instances_are_true = [&] {
      EXPECT_TRUE(same_instances(read_map_info(path_).instances, saved_.instances)) << what;
    };
    const std::string info_fault = fault_of(instances_are_true);
    const std::string fault =
        fault_of([&] { EXPECT_EQ(difference(saved_, load_map(path_)), "") << what; });
    EXPECT_EQ(fault.find('\n'), std::string::npos) << what;
    EXPECT_TRUE(info_fault.empty() || !fault.empty()) << what << ": only info says " << info_fault;
    bool listed = false;
    const std::string check_fault =
        fault_of([&] { listed = !check_map(path_).faults.empty(); });  // none may go unseen
    EXPECT_TRUE(fault.empty() || listed || !check_fault.empty()) << what << ": " << fault;
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

TEST_F(MapFileDamage, AFlippedBitIsFoundOrHarmless) {
  const Bytes intact = read_file(path_);
  std::vector<std::size_t> used;  // most of a small map's pages are zeros, which mean nothing
  for (std::size_t at = 0; at < intact.size(); ++at)
    if (intact[at] != 0) used.push_back(at);
  int refusals = 0;
  constexpr int kTrials = 1000;
  for (int trial = 0; trial < kTrials; ++trial) {
    Bytes bytes = intact;
    const std::size_t at =
        trial % 3 == 0 ? random_() % bytes.size() : used[random_() % used.size()];
    bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1u << random_() % 8));
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
  for (std::size_t length = 512; length < intact.size(); length += 1024) lengths.push_back(length);
  for (int i = 0; i < 50; ++i) lengths.push_back(random_() % intact.size());
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
                          "UPDATE instance_confidences SET confidence = 0.5",
                          "DROP TABLE instance_confidences",
                          "UPDATE super_point_frames SET last_frame = 4 WHERE label = 1",
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
  const std::string fault = fault_after("PRAGMA user_version = 8");
  EXPECT_NE(
      fault.find(
          "was written by a newer ovimap (schema 8, this program reads up to 7); update ovimap"),
      std::string::npos)
      << fault;
}

/// While alive, the process may not take more than `bytes` beyond what it has.
class MemoryLimit {
 public:
  explicit MemoryLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_AS, &old_);
    const rlimit limit{used() + bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_AS, &limit);
  }
  ~MemoryLimit() { ::setrlimit(RLIMIT_AS, &old_); }

 private:
  static rlim_t used() {
    std::ifstream statm("/proc/self/statm");
    rlim_t pages = 0;
    statm >> pages;
    return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
  }
  rlimit old_{};
};

/// Maps whose hashes are right but whose content is a lie.
class ForgedMap : public MapFileDamage {
 protected:
  /// Replaces a row's value and makes the table's check fit.
  template <class Fill>
  void forge(const MapTable& table, Fill&& fill) {
    SQLite::Database database(path_.string(), SQLite::OPEN_READWRITE);
    SQLite::Transaction transaction(database);
    drop_table(database, table);
    RowWriter rows(database, table);
    fill(rows);
    rows.finish();
    transaction.commit();
  }
  /// The table `meta` with one value changed.
  void forge_meta(const std::string& key, const std::string& value) {
    std::vector<std::pair<std::string, std::string>> all;
    {
      SQLite::Database database(path_.string());
      SQLite::Statement rows(database, "SELECT key, value FROM meta");
      while (rows.executeStep())
        all.emplace_back(rows.getColumn(0).getString(), rows.getColumn(1).getString());
    }
    forge(map_tables::kMeta, [&](RowWriter& rows) {
      for (const auto& [name, text] : all) rows.insert(name, name == key ? value : text);
    });
  }
  void expect_refused(const std::string& what) {
    std::string fault;
    {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
      const MemoryLimit limit(rlim_t{600} << 20);  // sanitizers reserve more than that
#endif
      fault = fault_of([&] { load_map(path_); });
      (void)fault_of([&] { check_map(path_); });
    }
    EXPECT_NE(fault.find("is damaged"), std::string::npos) << what << ": " << fault;
  }
};

TEST_F(ForgedMap, ClaimedSizesCostNothing) {
  forge_meta("blocks", "9223372036854775807");
  expect_refused("more blocks than can be");
  save_map(path_, saved_);
  forge_meta("blocks", "1");
  expect_refused("fewer blocks than there are");
  save_map(path_, saved_);
  forge_meta("last_instance_id", "4294967295");  // the next object would be number 0
  expect_refused("an id out of range");
  save_map(path_, saved_);
  forge_meta("encoder.dimension", "2000000000");
  expect_refused("an embedding of gigabytes");
  save_map(path_, saved_);
  forge_meta("map.voxel_size_m", "nan");
  expect_refused("voxels without size");
}

TEST_F(ForgedMap, TilesThatClaimEverythingAreRefusedAtOnce) {
  // A million blocks, 13 GB in memory, in a file of some hundred kilobytes.
  forge_meta("blocks", "1048576");
  const Bytes nothing = {0x28, 0xb5, 0x2f, 0xfd, 0x20, 0x00, 0x01, 0x00, 0x00};  // zstd of ""
  forge(map_tables::kBlocks, [&](RowWriter& rows) {
    for (int i = 0; i < 16384; ++i)
      rows.insert(static_cast<std::int64_t>(pack_index({i % 128, i / 128, 0})), std::int64_t{-1},
                  stored_hash(nothing), nothing);
  });
  expect_refused("tiles without content");
}

TEST_F(ForgedMap, LabelsAndRootsMustExist) {
  forge(map_tables::kLabelForest, [](RowWriter& rows) {
    Bytes roots(84, 0);
    for (std::size_t i = 0; i < roots.size(); i += 4) roots[i + 3] = 0xff;  // far beyond
    rows.insert(6, roots);
  });
  expect_refused("roots that were never given");
  save_map(path_, saved_);
  forge(map_tables::kInstanceSuperPoints, [](RowWriter& rows) { rows.insert(1, 4000000000u); });
  expect_refused("an object of labels that were never given");
}

TEST_F(ForgedMap, DirectionsMustFitTheMapsGrid) {
  MapDocument plain = random_document(6, 20);
  plain.semantics.looks.at(1).views[0].writing.clear();  // of a view that is replaced
  plain.semantics.looks.at(1).views[0].things.resize(0);
  const auto with_bins = [&](std::size_t bytes, std::uint8_t fill) {
    save_map(path_, plain);
    forge(map_tables::kSuperPointViews, [&](RowWriter& rows) {
      const Bytes none, first(96, 1);
      const Bytes bins(bytes, fill);
      for (const int frame : {1, 2})
        rows.insert(1, frame, 10, 0., 0., 0.,
                    std::span<const std::uint8_t>(frame == 1 ? first : bins),
                    std::span<const std::uint8_t>(none), std::span<const std::uint8_t>(none),
                    std::span<const std::uint8_t>(none), 0, 0, 0, 0);
    });
  };
  with_bins(96, 2);
  EXPECT_EQ(load_map(path_).semantics.looks.at(1).views.size(), 2u);
  with_bins(8, 1);
  expect_refused("fewer directions than the grid has");
  with_bins(9600, 1);
  expect_refused("more directions than the grid has");
}

TEST_F(ForgedMap, SurfacesAreFinite) {
  const auto floats = [](std::initializer_list<float> values) {
    Bytes bytes;
    for (const float value : values)
      for (std::size_t i = 0; i < 4; ++i)
        bytes.push_back(static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(value) >> 8 * i));
    return bytes;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Bytes& head :
       {floats({0, 0, nan, 1, 1, 1}), floats({-3e38f, 0, 0, 3e38f, 1, 1}), floats({0, 0, 0})}) {
    save_map(path_, saved_);
    forge(map_tables::kSurfaces, [&](RowWriter& rows) {
      Bytes surface = head;
      surface.resize(head.size() + 12, 7);
      rows.insert(1, std::span<const std::uint8_t>(surface));
    });
    expect_refused("surfaces nowhere");
  }
}

TEST_F(ForgedMap, EmbeddingsNeedAnEncoder) {
  forge_meta("encoder.name", "");
  expect_refused("embeddings in nobody's space");
}

TEST_F(ForgedMap, TheLogOfEditsIsReadWithCare) {
  const auto log = [&](const std::string& action, const std::string& arguments) {
    save_map(path_, saved_);
    forge(map_tables::kEdits, [&](RowWriter& rows) { rows.insert(1, 0.5, action, arguments, 0); });
    expect_refused(action + arguments);
  };
  log("explode", "{}");
  log("rename", "not JSON");
  log("rename", "{\"instances\": \"all\"}");
  log("merge", "{\"instances\": [-1, 5000000000]}");
  log("rename", "[1]");
  log("lock", "{}");
  log("merge", "{\"instances\": []}");
}

}  // namespace
}  // namespace ovimap
