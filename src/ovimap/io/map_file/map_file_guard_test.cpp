// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_file/map_file_guard.h"

#include <fstream>

#include <SQLiteCpp/SQLiteCpp.h>

#include "ovimap/image/codec.h"
#include "ovimap/io/map_file/map_check.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/map_file/map_file_access.h"
#include "ovimap/io/map_file/map_file_fixture.h"
#include "ovimap/io/map_file/searchable_map.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

/// What somebody with SQLite at hand may make of a map, or put beside it.
class HostileMap : public MapFolder {
 protected:
  HostileMap() { save_map(path_, saved_); }

  fs::path beside(const char* ending) const { return fs::path(path_) += ending; }

  /// What every way of reading says of the map; empty when one takes it.
  std::string fault() {
    const std::string said = fault_of([&] { load_map(path_); });
    EXPECT_FALSE(fault_of([&] { read_map_info(path_); }).empty() && !said.empty()) << said;
    EXPECT_FALSE(fault_of([&] { read_searchable_map(path_); }).empty() && !said.empty()) << said;
    EXPECT_FALSE(fault_of([&] { read_edits(path_); }).empty() && !said.empty()) << said;
    return said;
  }

  std::string fault_after(const std::string& sql) {
    save_map(path_, saved_);
    SQLite::Database(path_.string(), SQLite::OPEN_READWRITE).exec(sql);
    return fault();
  }

  /// The same map but for the name of its first object.
  Bytes renamed_map() {
    MapDocument other = random_document(6, 20);
    other.names[1] = "forged";
    save_map(root_ / "other", other);
    const Bytes bytes = read_file(root_ / "other");
    fs::remove(root_ / "other");
    return bytes;
  }

  /// A rollback journal that makes the map into another one.
  void put_journal(const Bytes& other, const std::string& names = {}) {
    constexpr std::size_t kPage = 4096, kSector = 512;
    Bytes journal = {0xd9, 0xd5, 0x05, 0xf9, 0x20, 0xa1, 0x63, 0xd7};
    const auto append = [&](std::size_t word) {
      for (int shift = 24; shift >= 0; shift -= 8)
        journal.push_back(static_cast<std::uint8_t>(word >> shift));
    };
    for (const std::size_t word :
         {other.size() / kPage, std::size_t{7}, other.size() / kPage, kSector, kPage})
      append(word);
    journal.resize(kSector);
    for (std::size_t page = 0; page * kPage < other.size(); ++page) {
      const std::uint8_t* bytes = other.data() + page * kPage;
      std::size_t sum = 7;
      for (std::size_t i = kPage - 200; i < kPage && i > 0; i -= 200) sum += bytes[i];
      append(page + 1);
      journal.insert(journal.end(), bytes, bytes + kPage);
      append(sum);
    }
    if (!names.empty()) {  // the journal of several files
      append((std::size_t{1} << 30) / kPage + 1);
      journal.insert(journal.end(), names.begin(), names.end());
      append(names.size());
      std::size_t sum = 0;
      for (const char c : names) sum += static_cast<std::size_t>(c);
      append(sum);
      journal.insert(journal.end(), {0xd9, 0xd5, 0x05, 0xf9, 0x20, 0xa1, 0x63, 0xd7});
    }
    write_file(beside("-journal"), journal);
  }

  /// A write-ahead log with a change of the map at `path`.
  static void put_wal(const fs::path& path) {
    const fs::path copy = fs::path(path) += ".copy";
    fs::copy_file(path, copy);
    {
      SQLite::Database database(copy.string(), SQLite::OPEN_READWRITE);
      database.exec("PRAGMA journal_mode = WAL; DELETE FROM instance_names");
      fs::copy_file(fs::path(copy) += "-wal", fs::path(path) += "-wal");
    }
    fs::remove(copy);
  }

  const MapDocument saved_ = random_document(6, 20);
  const fs::path path_ = root_ / "a.ovimap";
};

TEST_F(HostileMap, ComputedColumnsAreNeverComputed) {
  // The values of one row: gigabytes, in a file of some hundred kilobytes.
  const std::string big = "BLOB AS (zeroblob(999999999))";
  const std::string fault = fault_after(
      "DROP TABLE kept_frames; CREATE TABLE kept_frames (position INTEGER PRIMARY KEY, depth " +
      big + ", color " + big + ", segments " + big + ", labels " + big +
      "); INSERT INTO kept_frames (position) VALUES (0)");
  EXPECT_NE(fault.find("table kept_frames is not defined as in a map"), std::string::npos) << fault;
  EXPECT_NE(fault_after("CREATE TABLE more (a, b AS (zeroblob(999999999))); INSERT INTO more (a) "
                        "VALUES (1)")
                .find("'more' has computed columns"),
            std::string::npos);
  EXPECT_EQ(check_map(path_).faults.size(), 1u) << "examining does not compute them either";
}

TEST_F(HostileMap, TablesAreThoseOfAMap) {
  const auto expect = [&](const std::string& sql, const char* phrase) {
    const std::string fault = fault_after(sql);
    EXPECT_NE(fault.find("is damaged: " + std::string(phrase)), std::string::npos)
        << sql << ": " << fault;
    EXPECT_EQ(fault.find('\n'), std::string::npos);
  };
  expect("DROP TABLE votes; CREATE VIEW votes AS SELECT 1 AS label, 1 AS instance, 1 AS votes",
         "it holds the view 'votes'");
  expect("CREATE TRIGGER t AFTER DELETE ON frames BEGIN SELECT 1; END", "it holds the trigger 't'");
  expect("CREATE INDEX i ON frames (length(zeroblob(position)))", "it holds the index 'i'");
  expect("CREATE VIRTUAL TABLE v USING fts5(text)", "it holds the virtual table 'v'");
  expect("ALTER TABLE frames ADD COLUMN big AS (zeroblob(9))", "table frames is not defined");
  expect("DROP TABLE votes; CREATE TABLE VOTES (label, instance, votes)",
         "table votes is not defined");
  expect(
      "DROP TABLE meta; CREATE TABLE meta (key TEXT PRIMARY KEY CHECK (length(randomblob(9)) > "
      "0), value TEXT NOT NULL) WITHOUT ROWID",
      "table meta is not defined");
  EXPECT_EQ(fault_after("CREATE TABLE notes (text)"), "") << "what a newer program may add";
  EXPECT_EQ(fault_after("ANALYZE"), "");
}

TEST_F(HostileMap, AChangeOfAForeignSchemaIsRefused) {
  SQLite::Database(path_.string(), SQLite::OPEN_READWRITE)
      .exec("CREATE TRIGGER t AFTER INSERT ON checks BEGIN DELETE FROM frames; END");
  MapEdit edit;
  edit.action = EditAction::kRename;
  edit.instances = {1};
  edit.name = "x";
  EXPECT_NE(fault_of([&] { edit_map(path_, edit); }).find("holds the trigger"), std::string::npos);
}

TEST_F(HostileMap, AJournalBesideItIsNotTakenBack) {
  const Bytes intact = read_file(path_);
  put_journal(renamed_map());
  const std::string said = fault();
  EXPECT_NE(said.find("`ovimap info --recover " + path_.string() + "`"), std::string::npos) << said;
  EXPECT_TRUE(read_file(path_) == intact) << "reading changed the map";
  const fs::path link = root_ / "link";
  fs::create_symlink(path_, link);
  EXPECT_NE(fault_of([&] { read_map_info(link); }).find("--recover"), std::string::npos);
  EXPECT_TRUE(recover_map(path_)) << "whose map it is may have it taken back";
  EXPECT_FALSE(recover_map(path_));
  EXPECT_EQ(read_map_info(path_).names.at(1), "forged");
  EXPECT_FALSE(fs::exists(beside("-journal")));
}

TEST_F(HostileMap, AJournalThatNamesOtherFilesIsNeverTakenBack) {
  const fs::path other = root_ / "thesis.txt";
  std::ofstream(other) << "years of work";
  put_journal(renamed_map(), other.string());
  EXPECT_NE(fault_of([&] { recover_map(path_); }).find("is not of a map"), std::string::npos);
  EXPECT_TRUE(fs::exists(other));
  save_map(path_, saved_);  // takes the place of the map and what lies beside it
  EXPECT_EQ(fault_of([&] { load_map(path_); }), "");
  EXPECT_TRUE(fs::exists(other));
}

TEST_F(HostileMap, AWriteAheadLogBesideItIsNotTakenIn) {
  const Bytes intact = read_file(path_);
  put_wal(path_);
  const std::string said = fault();
  EXPECT_NE(said.find("`ovimap info --recover " + path_.string() + "`"), std::string::npos) << said;
  EXPECT_TRUE(read_file(path_) == intact);
  EXPECT_TRUE(recover_map(path_));
  EXPECT_FALSE(fs::exists(beside("-wal")));
  EXPECT_FALSE(check_map(path_).faults.empty()) << "the log took names away, and no check fits";
}

TEST_F(HostileMap, ALogOfARunsOwnCheckpointBelongsToIt) {
  const fs::path partial = root_ / "a.ovimap.partial";
  fs::copy_file(path_, partial);
  put_wal(partial);
  EXPECT_NE(fault_of([&] { load_map(partial); }).find("table instance_names has 0 rows"),
            std::string::npos);
}

TEST_F(HostileMap, AFileThatSaysItHasALogIsReadWithoutOne) {
  { SQLite::Database(path_.string(), SQLite::OPEN_READWRITE).exec("PRAGMA journal_mode = WAL"); }
  EXPECT_EQ(fault(), "");
  EXPECT_EQ(files_in_root(), 1u) << "reading left something beside it";
}

TEST_F(HostileMap, NoValueIsLongerThanItsFile) {
  const auto database =
      open_guarded(path_.string(), SQLite::OPEN_READONLY, longest_value_in(path_));
  EXPECT_LT(longest_value_in(path_), 4000000u);
  EXPECT_NO_THROW(database->execAndGet("SELECT length(zeroblob(1000000))"));
  EXPECT_THROW(database->execAndGet("SELECT length(randomblob(4000000))"), SQLite::Exception);
  EXPECT_THROW(database->exec("ATTACH ':memory:' AS more"), SQLite::Exception);
  EXPECT_EQ(database->execAndGet("PRAGMA trusted_schema").getInt(), 0);
}

}  // namespace
}  // namespace ovimap
