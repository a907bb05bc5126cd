// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_file/saved_tiles.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include "ovimap/base/parallel.h"
#include "ovimap/io/map_file/map_file_fixture.h"

namespace ovimap {
namespace {

using SavedTilesTest = MapFolder;

TEST_F(SavedTilesTest, BlocksAreThoseOfTheWholeMap) {
  const std::filesystem::path path = root_ / "a.ovimap";
  const MapDocument written = random_document(60, 3);
  save_map(path, written);
  const MapDocument document = load_map_by_tiles(path, 0);
  EXPECT_EQ(document.map.block_count(), written.map.block_count());
  EXPECT_EQ(document.map.blocks_in_memory(), 0u);
  EXPECT_EQ(document.instances.size(), written.instances.size());
  for (int round = 0; round < 2; ++round) {  // given up, and read again
    parallel_for(document.map.block_count(), 1, [&](std::size_t slot) {
      const VoxelBlock& block = document.map.block(static_cast<std::uint32_t>(slot));
      const VoxelBlock* same = written.map.find(block.index);
      ASSERT_TRUE(same);
      EXPECT_EQ(block.tsdf, same->tsdf);
      EXPECT_EQ(block.weight, same->weight);
    });
    EXPECT_EQ(document.map.blocks_in_memory(), document.map.block_count());
    EXPECT_EQ(document.map.content_hash(), written.map.content_hash());
    document.map.trim();
    EXPECT_EQ(document.map.blocks_in_memory(), 0u);
  }
}

TEST_F(SavedTilesTest, KeepsWhatTheBoundAllows) {
  const std::filesystem::path path = root_ / "a.ovimap";
  save_map(path, random_document(60, 3));
  const MapDocument document = load_map_by_tiles(path, 60 * VoxelBlock::kMostBytes);
  for (std::uint32_t slot = 0; slot < document.map.block_count(); ++slot) document.map.block(slot);
  document.map.trim();
  EXPECT_EQ(document.map.blocks_in_memory(), document.map.block_count());
}

TEST_F(SavedTilesTest, SaysWhichTileIsDamaged) {
  const std::filesystem::path path = root_ / "a.ovimap";
  save_map(path, random_document(60, 3));
  SQLite::Database(path.string(), SQLite::OPEN_READWRITE)
      .exec("UPDATE blocks SET data = zeroblob(50)");
  const MapDocument document = load_map_by_tiles(path, 0);
  const std::string fault = fault_of([&] { document.map.block(0); });
  EXPECT_NE(fault.find("damaged"), std::string::npos) << fault;
  EXPECT_NE(fault.find("tile"), std::string::npos) << fault;
}

}  // namespace
}  // namespace ovimap
