// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/mask_fusion.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

/// A 100 x 10 image; columns are given by "begin, end, id".
IdImage columns(std::initializer_list<std::array<int, 3>> spans) {
  IdImage ids(100, 10);
  for (const auto& [begin, end, id] : spans)
    for (int y = 0; y < 10; ++y)
      for (int x = begin; x < end; ++x) ids.at(x, y) = static_cast<std::uint16_t>(id);
  return ids;
}

DepthRegions regions_of(const IdImage& ids, int count) {
  DepthRegions regions{ids, std::vector<DepthRegion>(static_cast<std::size_t>(count))};
  for (std::uint16_t id : ids)
    if (id) ++regions.regions[id - 1u].area_px;
  return regions;
}

const DepthImage kDepth(100, 10, 1.f);

TEST(FuseMasks, SplitsSmallEntitiesOffAndTheRestTakesTheLargest) {
  // One region of 100 columns; entity 1 (20 columns) and 2 (15) lie inside, entity 3 covers 60.
  const Segments result = fuse_masks(regions_of(columns({{0, 100, 1}}), 1),
                                     columns({{0, 20, 1}, {20, 35, 2}, {40, 100, 3}}), kDepth, {});
  ASSERT_EQ(result.segments.size(), 3u);
  const auto entity_at = [&](int x) { return result.segments[result.ids.at(x, 5) - 1u].entity; };
  EXPECT_EQ(entity_at(10), 1);
  EXPECT_EQ(entity_at(30), 2);
  EXPECT_EQ(entity_at(37), 3) << "the uncovered gap belongs to the rest";
  EXPECT_EQ(entity_at(70), 3);
  EXPECT_EQ(result.segments[result.ids.at(70, 5) - 1u].area_px, 650);
}

TEST(FuseMasks, KeepsARegionWithoutEnoughEntityAsBackground) {
  // Entity 1 is mostly in region 2, so the strip of 6 of 60 columns is not split off region 1.
  const Segments result = fuse_masks(regions_of(columns({{0, 60, 1}, {60, 100, 2}}), 2),
                                     columns({{54, 100, 1}}), kDepth, {});
  ASSERT_EQ(result.segments.size(), 2u);
  EXPECT_EQ(result.segments[result.ids.at(0, 0) - 1u].entity, 0);
  EXPECT_EQ(result.segments[result.ids.at(99, 0) - 1u].entity, 1);
}

TEST(FuseMasks, SplitsOffWhatIsNoMereStripOfAnEntity) {
  // A wall with a door, which make one region: the door is more than half of it, and the next
  // entity goes on in another region.
  const DepthRegions regions = regions_of(columns({{0, 60, 1}, {60, 100, 2}}), 2);
  const IdImage entities = columns({{0, 20, 1}, {20, 53, 2}, {53, 100, 3}});
  const auto segments_with = [&](int core_px) {
    MaskFusionConfig config;
    config.split_core_px = core_px;
    return fuse_masks(regions, entities, kDepth, config);
  };
  const Segments result = segments_with(7);
  ASSERT_EQ(result.segments.size(), 4u);
  const auto entity_at = [&](int x) { return result.segments[result.ids.at(x, 5) - 1u].entity; };
  EXPECT_EQ(entity_at(10), 1);
  EXPECT_EQ(entity_at(30), 2);
  EXPECT_EQ(entity_at(56), 3);
  EXPECT_EQ(entity_at(80), 3);
  EXPECT_NE(result.ids.at(56, 5), result.ids.at(80, 5));
  EXPECT_EQ(segments_with(8).segments.size(), 3u) << "7 columns hold no square of 8";
}

TEST(FuseMasks, DoesNotDependOnEntityNumbers) {
  const DepthRegions regions = regions_of(columns({{0, 100, 1}}), 1);
  const Segments a =
      fuse_masks(regions, columns({{0, 45, 1}, {45, 90, 2}, {90, 100, 3}}), kDepth, {});
  const Segments b =
      fuse_masks(regions, columns({{0, 45, 9}, {45, 90, 4}, {90, 100, 2}}), kDepth, {});
  const auto same_cut = [](const IdImage& ids, int x1, int x2) {
    return ids.at(x1, 0) == ids.at(x2, 0);
  };
  for (int x = 1; x < 100; ++x)
    EXPECT_EQ(same_cut(a.ids, x - 1, x), same_cut(b.ids, x - 1, x)) << x;
}

TEST(FuseMasks, FoundsASegmentForAnEntityOutsideEveryRegion) {
  const Segments result =
      fuse_masks(regions_of(columns({{0, 50, 1}}), 1), columns({{70, 90, 5}}), kDepth, {});
  ASSERT_EQ(result.segments.size(), 2u);
  EXPECT_EQ(result.segments[result.ids.at(80, 0) - 1u].entity, 5);
  EXPECT_EQ(result.ids.at(60, 0), 0);
}

TEST(FuseMasks, IgnoresPixelsWithoutDepth) {
  DepthImage depth(100, 10, 1.f);
  for (int y = 0; y < 10; ++y) depth.at(80, y) = 0.f;
  const Segments result = fuse_masks(regions_of(columns({}), 0), columns({{70, 90, 5}}), depth, {});
  ASSERT_EQ(result.segments.size(), 1u);
  EXPECT_EQ(result.segments[0].area_px, 190);
  EXPECT_EQ(result.ids.at(80, 0), 0);
}

TEST(SegmentsOfRegions, OneSegmentPerRegion) {
  const DepthRegions regions = regions_of(columns({{0, 30, 1}, {30, 100, 2}}), 2);
  const Segments result = segments_of_regions(regions);
  EXPECT_EQ(result.ids, regions.ids);
  EXPECT_EQ(result.segments[1].area_px, 700);
  EXPECT_EQ(result.segments[1].entity, 0);
}

}  // namespace
}  // namespace ovimap
