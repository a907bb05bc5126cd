// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_tables/map_file_blocks.h"

#include <bit>
#include <limits>

#include <zstd.h>

#include "ovimap/io/map_file/map_file_fixture.h"

namespace ovimap {
namespace {

/// The map after a trip through its tiles.
VoxelMap through_tiles(const VoxelMap& map) {
  VoxelMap result(map.config());
  result.labels() = map.labels();
  TileEncoder encoder;
  TileDecoder decoder;
  for (const Tile& tile : tiles_of(map)) {
    const Tile fresh = create_tile(result, tile.key, tile.present);
    EXPECT_EQ(decoder.decode(encoder.encode(blocks_of(map, tile)), kSchemaWithSteps, fresh, result),
              "");
  }
  return result;
}

TEST(MapFileBlocks, TilesHoldEveryBlockOnce) {
  const VoxelMap map = random_map(300, 1);
  std::vector<std::uint32_t> slots;
  std::uint64_t last_key = 0;
  for (const Tile& tile : tiles_of(map)) {
    EXPECT_TRUE(slots.empty() || tile.key > last_key);
    EXPECT_TRUE(valid_tile_key(tile.key));
    last_key = tile.key;
    int bit = -1;
    for (std::uint32_t slot : tile.slots) {
      do ++bit;
      while ((tile.present >> bit & 1) == 0);
      const BlockIndex place = map.block(slot).index - unpack_index(tile.key) * 4;
      EXPECT_EQ(place.x() + 4 * place.y() + 16 * place.z(), bit);
      slots.push_back(slot);
    }
  }
  std::sort(slots.begin(), slots.end());
  EXPECT_TRUE(std::adjacent_find(slots.begin(), slots.end()) == slots.end());
  EXPECT_EQ(slots.size(), map.block_count());
}

TEST(MapFileBlocks, NegativeIndicesBelongToTheTileBelow) {
  VoxelMap map;
  map.find_or_create({-1, -4, -5});
  const std::vector<Tile> tiles = tiles_of(map);
  ASSERT_EQ(tiles.size(), 1u);
  EXPECT_EQ(tiles[0].key, pack_index({-1, -1, -2}));
  EXPECT_EQ(tiles[0].present, std::uint64_t{1} << (3 + 4 * 0 + 16 * 3));
}

TEST(MapFileBlocks, RefusesKeysWhoseBlocksCannotBe) {
  EXPECT_TRUE(valid_tile_key(pack_index({-(1 << 18), (1 << 18) - 1, 0})));
  EXPECT_FALSE(valid_tile_key(pack_index({0, 1 << 18, 0})));
  EXPECT_FALSE(valid_tile_key(pack_index({0, 0, -(1 << 18) - 1})));
  EXPECT_FALSE(valid_tile_key(pack_index({0, 0, 0}) | std::uint64_t{1} << 63));
}

TEST(MapFileBlocks, RandomBlocksReturnBitForBit) {
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    const VoxelMap map = random_map(200, seed);
    EXPECT_TRUE(same_voxels(map, through_tiles(map)));
  }
}

TEST(MapFileBlocks, RowsWithObservedVoxelsAreNoted) {
  const VoxelMap map = through_tiles(random_map(50, 3));
  for (std::uint32_t slot = 0; slot < map.block_count(); ++slot)
    for (std::size_t v = 0; v < kBlockVoxels; ++v)
      ASSERT_TRUE(map.block(slot).weight[v] <= 0.f ||
                  map.block(slot).observed_rows >> v / kBlockSide & 1);
}

TEST(MapFileBlocks, ADistanceOfZeroIsReadAsOneWhereTheVoxelWasObserved) {
  VoxelMap map;
  VoxelBlock& block = map.writable_block(map.find_or_create({0, 0, 0}));
  block.weight[7] = 1.f;  // as older programs wrote it
  const VoxelMap read = through_tiles(map);
  EXPECT_EQ(read.block(0).tsdf[7], 1);
  EXPECT_EQ(read.block(0).tsdf[8], 0);
}

TEST(MapFileBlocks, DoubtsTakeNoSpaceWhereThereAreNone) {
  VoxelMap map;
  VoxelBlock& block = map.writable_block(map.find_or_create({0, 0, 0}));
  block.weight[7] = 1.f, block.tsdf[7] = 5;
  TileEncoder encoder;
  const std::vector<Tile> tiles = tiles_of(map);
  const Bytes without = encoder.encode(blocks_of(map, tiles[0]));
  const std::uint64_t hash = map.content_hash();
  block.doubts.resize(kBlockVoxels);
  EXPECT_EQ(encoder.encode(blocks_of(map, tiles[0])), without);
  EXPECT_EQ(map.content_hash(), hash);
  block.doubts[7] = 3;
  EXPECT_NE(map.content_hash(), hash);
  const VoxelMap again = through_tiles(map);
  EXPECT_EQ(again.block(0).doubts[7], 3);
  EXPECT_EQ(again.content_hash(), map.content_hash());
}

TEST(MapFileBlocks, ExtremeBlocksReturnBitForBit) {
  VoxelMap map;
  for (int i = 0; i < 300; ++i) map.labels().create();
  (void)map.find_or_create({0, 0, 0});  // empty
  VoxelBlock& full = map.writable_block(map.find_or_create({1, 0, 0}));
  for (Label label = 1; label < 256; ++label) full.palette.push_back(label);
  for (std::size_t v = 0; v < kBlockVoxels; ++v) {
    full.tsdf[v] = v % 2 == 0 ? std::numeric_limits<std::int16_t>::min()
                              : std::numeric_limits<std::int16_t>::max();
    full.weight[v] = v % 2 == 0 ? 1e6f : static_cast<float>(8388608 + v) / kWeightSteps;
    full.color[v] = v % 3 == 0 ? 0 : 0xffffffff;
    for (std::size_t s = 0; s < kLabelSlots; ++s) {
      full.slot(s).label[v] = static_cast<std::uint8_t>(255 - v % 256);
      full.slot(s).support[v] = v % 256 == 255 ? 0 : 0xffff;
    }
  }
  VoxelBlock& lone =
      map.writable_block(map.find_or_create({2, 0, 0}));  // one voxel, known by its colour alone
  lone.color[511] = 1;
  EXPECT_TRUE(same_voxels(map, through_tiles(map)));
}

/// Decodes a body that was changed before compression, so that only the decoder's checks stand
/// guard.
class TileBody : public ::testing::Test {
 protected:
  TileBody() : map_(random_map(40, 7)), tile_(tiles_of(map_)[1]) {
    const Bytes data = TileEncoder().encode(blocks_of(map_, tile_));
    body_.resize(std::size_t{1} << 20);
    body_.resize(ZSTD_decompress(body_.data(), body_.size(), data.data(), data.size()));
  }

  std::string fault(const Bytes& body, int schema = kSchemaWithSteps) const {
    Bytes data(ZSTD_compressBound(body.size()));
    data.resize(ZSTD_compress(data.data(), data.size(), body.data(), body.size(), 1));
    VoxelMap map;
    map.labels() = map_.labels();
    return TileDecoder().decode(data, schema, create_tile(map, tile_.key, tile_.present), map);
  }

  const VoxelMap map_;
  const Tile tile_;
  Bytes body_;
};

/// Of a tile with one voxel, whose weight is written as maps before schema 7 have it; negative:
/// refused.
float weight_of_old_tile(float written) {
  VoxelBlock block({0, 0, 0});
  block.weight[0] = 1.f;
  const VoxelBlock* one = &block;
  Bytes body(4096);
  const Bytes data = TileEncoder().encode(std::span(&one, 1));
  body.resize(ZSTD_decompress(body.data(), body.size(), data.data(), data.size()));
  const auto bits = std::bit_cast<std::int32_t>(written);
  const std::uint32_t code = static_cast<std::uint32_t>(bits) << 1 ^ (bits < 0 ? ~0u : 0u);
  const std::size_t low = body.size() - 7;  // distance, weight 3, colour 3
  for (std::size_t i = 0; i < 3; ++i) body[low + 1 + i] = static_cast<std::uint8_t>(code >> 8 * i);
  body[low - 4] = static_cast<std::uint8_t>(code >> 24);  // before the colours' high bytes

  StoredTile tile{1, Bytes(ZSTD_compressBound(body.size()))};
  tile.data.resize(ZSTD_compress(tile.data.data(), tile.data.size(), body.data(), body.size(), 1));
  if (!renew_tile(tile, kSchemaWithSteps - 1, LabelForest()).empty()) return -1.f;
  VoxelBlock read({0, 0, 0});
  VoxelBlock* place = &read;
  EXPECT_EQ(TileDecoder().decode(tile.data, kSchemaWithSteps, std::span(&place, 1), LabelForest()),
            "");
  return read.weight[0];
}

TEST(OldTiles, HaveTheirWeightsAsFloats) {
  EXPECT_EQ(weight_of_old_tile(0.f), 0.f);
  EXPECT_EQ(weight_of_old_tile(-0.f), 0.f);
  EXPECT_EQ(weight_of_old_tile(12.5f), 12.5f);
  EXPECT_EQ(weight_of_old_tile(1.f / 4096), 1.f / kWeightSteps) << "it was observed";
  EXPECT_EQ(weight_of_old_tile(1e6f), 1e6f);
  EXPECT_GT(weight_of_old_tile(std::numeric_limits<float>::max()), 1e6f);
  EXPECT_EQ(weight_of_old_tile(-1.f), -1.f);
  EXPECT_EQ(weight_of_old_tile(std::numeric_limits<float>::infinity()), -1.f);
  EXPECT_EQ(weight_of_old_tile(std::numeric_limits<float>::quiet_NaN()), -1.f);
}

TEST_F(TileBody, NoChangeCrashesTheDecoder) {
  EXPECT_EQ(fault(body_), "");
  std::mt19937 random(5);
  int faults = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    Bytes body = body_;
    const std::size_t head = tile_.slots.size() * 100;  // where every byte counts
    for (int change = 0; change < 3; ++change)
      body[random() % (trial % 2 == 0 ? std::min(head, body.size()) : body.size())] =
          static_cast<std::uint8_t>(random());
    if (trial % 5 == 0) body.resize(random() % body.size());
    faults += !fault(body, kSchemaWithSteps - trial / 2 % 2).empty();
  }
  EXPECT_GT(faults, 1000);
}

TEST_F(TileBody, NamesWhatIsWrong) {
  const auto with = [&](std::size_t at, std::uint8_t value) {
    Bytes body = body_;
    body[at] = value;
    return fault(body);
  };
  const std::size_t blocks = tile_.slots.size();
  EXPECT_NE(with(3, 0xff).find("newer than the table of merged labels"), std::string::npos);
  EXPECT_NE(with(4 * blocks + 1, 0xff).find("a palette cannot have"), std::string::npos);
  EXPECT_NE(with(6 * blocks, 1).find("does not begin with 'no label'"), std::string::npos);
  EXPECT_NE(with(6 * blocks + 3, 0x7f).find("was never given"), std::string::npos);
  EXPECT_NE(fault(Bytes(body_.begin(), body_.end() - 1)).find("are expected"), std::string::npos);
  EXPECT_NE(fault({1, 2}).find("heads are cut off"), std::string::npos);
}

TEST_F(TileBody, ABodyTooLargeIsRefused) {
  EXPECT_NE(fault(Bytes(std::size_t{10} << 20)).find("does not decompress"), std::string::npos);
}

}  // namespace
}  // namespace ovimap
