// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/voxels/voxel_map.h"

#include <random>
#include <set>

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"

namespace ovimap {
namespace {

TEST(PackIndex, RoundTripsAndOrdersByZThenYThenX) {
  std::mt19937 random(2);
  std::uniform_int_distribution<int> axis(-100000, 100000);
  for (int i = 0; i < 1000; ++i) {
    const BlockIndex index(axis(random), axis(random), axis(random));
    EXPECT_EQ(unpack_index(pack_index(index)), index);
  }
  EXPECT_LT(pack_index({5, 5, -1}), pack_index({-5, -5, 0}));
  EXPECT_LT(pack_index({5, -1, 0}), pack_index({-5, 0, 0}));
}

TEST(PackedIndexHash, SpreadsAWallOfOneX) {  // a table of them took 20 GB
  constexpr int kSide = 64;
  std::set<std::size_t> places;
  for (int z = 0; z < kSide; ++z)
    for (int y = 0; y < kSide; ++y)
      places.insert(PackedIndexHash{}(pack_index({25, y, z})) % (kSide * kSide));
  EXPECT_GT(places.size(), kSide * kSide / 2u) << "chance leaves a third of the places empty";
}

TEST(VoxelMap, FindsWhatWasCreated) {
  VoxelMap map;
  EXPECT_EQ(map.find({1, -2, 3}), nullptr);
  const std::uint32_t slot = map.find_or_create({1, -2, 3});
  EXPECT_EQ(map.find_or_create({1, -2, 3}), slot);
  EXPECT_EQ(map.find({1, -2, 3})->index, BlockIndex(1, -2, 3));
  EXPECT_EQ(map.find({1, -2, 4}), nullptr);
  ASSERT_NE(map.find_region({0, -1, 0}), nullptr);
  EXPECT_EQ(map.find_region({0, -1, 0})->slot({1, -2, 3}), slot);
  EXPECT_EQ(map.find_region({1, -1, 0}), nullptr);
}

TEST(VoxelRef, EveryVoxelOfEveryBlockHasANumberOfItsOwn) {
  constexpr auto kLast = static_cast<std::uint32_t>(VoxelRef::kMostBlocks - 1);
  const VoxelRef last = VoxelRef::of(kLast, kBlockVoxels - 1);
  EXPECT_TRUE(last);
  EXPECT_EQ(last.block(), kLast);
  EXPECT_EQ(last.voxel(), kBlockVoxels - 1);
  EXPECT_FALSE(VoxelRef::of(kLast + 1, kBlockVoxels - 1)) << "one more block would not fit";
}

TEST(VoxelMap, RefusesMoreBlocksThanCanBeReferredTo) {
  VoxelMap map({}, 2);
  map.find_or_create({0, 0, 0});
  map.find_or_create({1, 0, 0});
  EXPECT_EQ(map.find_or_create({1, 0, 0}), 1u) << "what is there can be found";
  for (int attempt = 0; attempt < 2; ++attempt) {
    const std::string fault = error_of([&] { map.find_or_create({2, 0, 0}); });
    EXPECT_NE(fault.find("at most 2 blocks"), std::string::npos);
    EXPECT_NE(fault.find("map.voxel_size_m"), std::string::npos);
  }
  EXPECT_THROW(map.create_away({2, 0, 0}), Error);
  EXPECT_EQ(map.block_count(), 2u);
  EXPECT_EQ(map.find({2, 0, 0}), nullptr);
}

TEST(VoxelMap, ContentHashIgnoresCreationOrderAndSeesEveryVoxel) {
  VoxelMap a, b;
  a.find_or_create({0, 0, 0});
  a.find_or_create({1, 0, 0});
  b.find_or_create({1, 0, 0});
  b.find_or_create({0, 0, 0});
  EXPECT_EQ(a.content_hash(), b.content_hash());
  b.writable_block(0).tsdf[511] = 1;
  EXPECT_NE(a.content_hash(), b.content_hash());
}

TEST(PackedColor, IsReadAsItWasPackedToAQuarterOfALevel) {
  for (int level = 0; level < 256; ++level) {
    const auto fixed = static_cast<std::uint16_t>(level * 256 + 96);
    const FixedColor read = unpack_color(pack_color({fixed, fixed, fixed}));
    EXPECT_EQ(read[0], fixed);
    EXPECT_EQ(read[1], fixed);
    EXPECT_NEAR(read[2], fixed, 32);
    EXPECT_EQ(pack_color(read), pack_color({fixed, fixed, fixed}));
  }
  const auto brightest = color_levels(pack_color({0xffff, 0xffff, 0xffff}));
  EXPECT_EQ(brightest, (std::array<std::uint8_t, 3>{255, 255, 255}));
  EXPECT_EQ(color_levels(pack_color({200 << 8, 1 << 8, 50 << 8})),
            (std::array<std::uint8_t, 3>{200, 1, 50}));
}

TEST(VoxelBlock, TakesTenBytesAVoxelAndThreeMoreForEachLabel) {
  VoxelBlock block({0, 0, 0});
  EXPECT_LE(block.bytes(), 10u * kBlockVoxels + 110u);
  block.slot(2).label[7] = 1;
  EXPECT_LE(block.bytes(), (10u + 3 * 3) * kBlockVoxels + 110u);
  EXPECT_LE(VoxelBlock::kMostBytes, 22u * kBlockVoxels + 110u);
}

}  // namespace
}  // namespace ovimap
