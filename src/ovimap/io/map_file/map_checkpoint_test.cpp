// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_file/map_checkpoint.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <set>
#include <thread>

#include "ovimap/image/codec.h"
#include "ovimap/io/map_file/map_file_fixture.h"
#include "ovimap/io/map_tables/map_file_blocks.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

using Checkpoints = MapFolder;

/// The map as it is, with the tiles of the given slots.
MapCheckpoint checkpoint_of(const MapDocument& document, const std::vector<std::uint32_t>& slots) {
  MapCheckpoint checkpoint{
      document, document.map.config(), document.map.labels(), document.map.block_count(), {}};
  checkpoint.record.unfinished = true;
  std::set<std::uint64_t> keys;
  for (const std::uint32_t slot : slots) keys.insert(tile_key(document.map.block(slot).index));
  for (const std::uint64_t key : keys) {
    const Tile tile = tile_at(document.map, key);
    checkpoint.tiles.push_back({key, tile.present, blocks_of(document.map, tile)});
  }
  return checkpoint;
}

/// Changes some blocks and everything that a checkpoint writes anew; returns the slots.
std::vector<std::uint32_t> go_on(MapDocument& document, std::mt19937& random) {
  std::vector<std::uint32_t> changed;
  for (int i = 0; i < 5; ++i) {
    const BlockIndex index(static_cast<int>(random() % 12), static_cast<int>(random() % 12), -3);
    changed.push_back(document.map.find_or_create(index));
    document.map.writable_block(changed.back()).tsdf[random() % 512] = 77;
  }
  document.frames.push_back(document.frames.back());
  document.registry.entity_frames += 2;
  return changed;
}

TEST_F(Checkpoints, EachOneIsTheWholeMap) {
  std::mt19937 random(1);
  MapDocument document = random_document(40, 1);
  const fs::path path = checkpoint_path(root_ / "a.ovimap");
  {
    CheckpointFile file(path, CheckpointFile::Start::kAnew);
    file.write(checkpoint_of(document, document.map.ordered_slots()));
    for (int round = 0; round < 4; ++round) {
      const std::vector<std::uint32_t> changed = go_on(document, random);
      file.write(checkpoint_of(document, changed));
    }
  }
  const MapDocument loaded = load_map(path);
  EXPECT_TRUE(loaded.unfinished);
  EXPECT_EQ(loaded.registry.entity_frames, 8);
  EXPECT_EQ(difference(document, loaded), "");
  EXPECT_TRUE(read_map_info(path).unfinished);
}

/// Two runs that were to write the same map, of which one was faster.
TEST_F(Checkpoints, AreNotTakenFromAnotherRun) {
  const MapDocument document = random_document(40, 1);
  const fs::path path = root_ / "a.partial";
  const auto fault = [&] {
    return fault_of([&] { CheckpointFile slower(path, CheckpointFile::Start::kAnew); });
  };
  {
    CheckpointFile faster(path, CheckpointFile::Start::kAnew);
    faster.write(checkpoint_of(document, document.map.ordered_slots()));
    EXPECT_NE(fault().find("in use by another program"), std::string::npos) << fault();
    faster.write(checkpoint_of(document, {}));
  }
  EXPECT_NE(fault().find("another run left"), std::string::npos) << fault();
  EXPECT_EQ(difference(document, load_map(path)), "");
}

TEST_F(Checkpoints, GoOnInTheSameFile) {
  std::mt19937 random(2);
  MapDocument document = random_document(40, 2);
  const fs::path path = root_ / "a.partial";
  CheckpointFile(path, CheckpointFile::Start::kAnew)
      .write(checkpoint_of(document, document.map.ordered_slots()));
  const std::vector<std::uint32_t> changed = go_on(document, random);
  CheckpointFile(path, CheckpointFile::Start::kGoOn).write(checkpoint_of(document, changed));
  EXPECT_EQ(difference(document, load_map(path)), "");
  CheckpointFile(path, CheckpointFile::Start::kGoOn).remove_when_closed();
  EXPECT_EQ(files_in_root(), 0u);
}

TEST_F(Checkpoints, TilesPutInBetweenCountFromTheNextOn) {
  std::mt19937 random(5);
  MapDocument document = random_document(40, 5);
  const MapDocument before = random_document(40, 5);
  const fs::path path = root_ / "a.partial";
  const auto put_changes = [&](CheckpointFile& file) {
    for (const ChangedTile& tile : checkpoint_of(document, go_on(document, random)).tiles) {
      const StoredTile stored{tile.present, TileEncoder().encode(tile.blocks)};
      file.put(tile.key, stored);
      EXPECT_EQ(file.get(tile.key).present, stored.present);
      EXPECT_EQ(file.get(tile.key).data, stored.data);
    }
  };
  {
    CheckpointFile file(path, CheckpointFile::Start::kAnew);
    file.write(checkpoint_of(document, document.map.ordered_slots()));
    put_changes(file);
  }
  EXPECT_EQ(difference(before, load_map(path)), "") << "no checkpoint came after them";
  document = random_document(40, 5);
  {
    CheckpointFile file(path, CheckpointFile::Start::kGoOn);
    put_changes(file);
    file.write(checkpoint_of(document, {}));
  }
  EXPECT_EQ(difference(document, load_map(path)), "");
}

TEST_F(Checkpoints, OneOfAnOlderProgramIsNotGoneOnWith) {
  const MapDocument document = random_document(4, 3);
  const fs::path path = root_ / "a.partial";
  CheckpointFile(path, CheckpointFile::Start::kAnew)
      .write(checkpoint_of(document, document.map.ordered_slots()));
  SQLite::Database(path.string(), SQLite::OPEN_READWRITE)
      .exec(concat("PRAGMA user_version = ", kMapSchema - 1));
  const std::string fault = fault_of([&] { CheckpointFile(path, CheckpointFile::Start::kGoOn); });
  EXPECT_NE(fault.find("begun by an older ovimap"), std::string::npos) << fault;
  EXPECT_TRUE(fs::exists(path)) << "for the program that began it";
}

TEST_F(Checkpoints, AFinishedRunsFileHoldsNone) {
  const fs::path path = root_ / "room.ovimap.partial", copy = root_ / "killed.partial";
  const MapDocument document = random_document(20, 1);
  CheckpointFile file(path, CheckpointFile::Start::kAnew);
  file.write(checkpoint_of(document, document.map.ordered_slots()));
  file.put(7, {1, {1, 2, 3}});
  file.remove_when_closed();
  EXPECT_EQ(file.get(7).data, (Bytes{1, 2, 3})) << "tiles are needed while the map is looked at";
  for (const char* suffix : {"", "-wal"})  // what a power cut would leave now
    if (fs::exists(path.string() + suffix))
      fs::copy_file(path.string() + suffix, copy.string() + suffix);
  EXPECT_FALSE(holds_checkpoint(copy));
}

TEST_F(Checkpoints, ASecondWriterIsRefused) {
  const MapDocument document = random_document(4, 3);
  const fs::path path = root_ / "a.partial";
  CheckpointFile first(path, CheckpointFile::Start::kAnew);
  first.write(checkpoint_of(document, document.map.ordered_slots()));
  EXPECT_NE(fault_of([&] {
              CheckpointFile(path, CheckpointFile::Start::kGoOn);
            }).find("in use by another program"),
            std::string::npos);
  first.write(checkpoint_of(document, {}));
}

TEST_F(Checkpoints, AFolderThatCannotBeWrittenIsNamed) {
  EXPECT_NE(fault_of([&] {
              CheckpointFile(root_ / "no" / "a.partial", CheckpointFile::Start::kAnew);
            }).find("choose a folder"),
            std::string::npos);
}

/// Writes checkpoints until it is killed, a byte to `begun` after the first. The state after n of
/// them is known from n alone.
[[noreturn]] void write_for_ever(const fs::path& path, int begun) {
  std::mt19937 random(4);
  MapDocument document = random_document(60, 4);
  CheckpointFile file(path, CheckpointFile::Start::kAnew);
  file.write(checkpoint_of(document, document.map.ordered_slots()));
  if (::write(begun, "!", 1) != 1) std::abort();
  for (;;) {
    const std::vector<std::uint32_t> changed = go_on(document, random);
    file.write(checkpoint_of(document, changed));
  }
}

TEST_F(Checkpoints, KilledInTheMiddleOfWritingLeavesTheOneBefore) {
  const fs::path path = root_ / "a.partial";
  std::mt19937 when(4);
  for (int round = 0; round < 20; ++round) {
    fs::remove(path);
    int pipe[2];
    ASSERT_EQ(::pipe(pipe), 0);
    const pid_t child = ::fork();
    if (child == 0) write_for_ever(path, pipe[1]);
    ::close(pipe[1]);
    char begun = 0;
    ASSERT_EQ(::read(pipe[0], &begun, 1), 1);
    ::close(pipe[0]);
    std::this_thread::sleep_for(std::chrono::milliseconds(when() % 100));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const MapDocument loaded = load_map(path);
    MapDocument expected = random_document(60, 4);
    std::mt19937 random(4);
    while (expected.frames.size() < loaded.frames.size()) go_on(expected, random);
    EXPECT_EQ(difference(expected, loaded), "") << "round " << round;
  }
}

}  // namespace
}  // namespace ovimap
