// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/object_parts.h"

#include <gtest/gtest.h>

#include "ovimap/map/rays/sphere_fixture.h"

namespace ovimap {
namespace {

using Frame = std::map<Label, std::uint16_t>;  // entity by root

EntitySightings seen_in(const std::vector<Frame>& frames) {
  EntitySightings sightings;
  for (std::uint32_t frame = 0; frame < frames.size(); ++frame)
    for (const auto& [root, entity] : frames[frame]) sightings[root].push_back({frame, entity});
  return sightings;
}

const std::vector<Label> kCabinet{3, 5, 8};

TEST(FindParts, AreWhatMasksKeepApart) {
  const Frame apart{{3, 1}, {5, 2}, {8, 2}};  // 3 a drawer, 5 and 8 the body
  const auto parts = find_parts(kCabinet, seen_in({apart, apart, apart}), 3);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].id, 3u);
  EXPECT_EQ(parts[0].super_points, std::vector<Label>{3});
  EXPECT_EQ(parts[0].views, 3);
  EXPECT_EQ(parts[1].super_points, (std::vector<Label>{5, 8}));
}

TEST(FindParts, NeedFramesThatTellThem) {
  const Frame apart{{3, 1}, {5, 2}, {8, 2}};
  EXPECT_TRUE(find_parts(kCabinet, seen_in({apart, apart}), 3).empty());
  const Frame alone{{3, 1}};  // shows no other side of a border
  EXPECT_TRUE(find_parts(kCabinet, seen_in({apart, apart, alone, alone}), 3).empty());
}

TEST(FindParts, OneThingToTheMasksHasNone) {
  const Frame apart{{3, 1}, {5, 2}, {8, 2}}, whole{{3, 1}, {5, 1}, {8, 1}};
  EXPECT_TRUE(find_parts(kCabinet, seen_in({whole, whole, whole}), 1).empty());
  EXPECT_TRUE(
      find_parts(kCabinet, seen_in({apart, apart, apart, whole, whole, whole, whole}), 3).empty());
  EXPECT_TRUE(find_parts({}, {}, 1).empty());
  EXPECT_TRUE(find_parts(kCabinet, {}, 1).empty()) << "nobody masked it";
}

TEST(FindParts, AreMeasuredAndNeitherTinyNorAllOfTheirObject) {
  const SphereScene scene;
  VoxelMap map;
  const Label ball = map.labels().create(), cap = map.labels().create();
  scene.integrate_views(map, 8, ball);
  InstanceSummary object;
  object.id = 1;
  object.super_points = {ball, cap};
  std::vector<InstanceSummary> objects{object};
  const SurfaceExtents extents = surface_extents(map);
  measure_instances(extents, objects);
  const Frame apart{{ball, 1}, {cap, 2}};
  const EntitySightings sightings = seen_in({apart, apart, apart});
  EXPECT_TRUE(find_parts(extents, objects, sightings, {}).empty()) << "the cap has no surface";
  const auto parts = find_parts(extents, objects, sightings, {.max_part_share = 1});
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].id, ball);
  EXPECT_EQ(parts[0].points, objects[0].points);
  EXPECT_NEAR(parts[0].box.max().x(), SphereScene::kRadius, 0.02f);
}

TEST(PartsByObject, FollowCorrections) {
  ObjectPart drawer, body;
  drawer.id = 3, drawer.super_points = {3};
  body.id = 5, body.super_points = {5, 8};
  const std::vector<ObjectPart> parts{drawer, body};
  InstanceSummary cabinet, shelf;
  cabinet.id = 1, cabinet.super_points = {3, 5, 8};
  EXPECT_EQ(parts_by_object(parts, {{cabinet}}).at(1).size(), 2u);
  // Taken apart through the body: only the drawer is still whole.
  cabinet.super_points = {3, 5};
  shelf.id = 2, shelf.super_points = {8};
  const auto after = parts_by_object(parts, {{cabinet, shelf}});
  ASSERT_EQ(after.size(), 1u);
  ASSERT_EQ(after.at(1).size(), 1u);
  EXPECT_EQ(after.at(1)[0]->id, 3u);
  cabinet.super_points = {8};
  EXPECT_TRUE(parts_by_object(parts, {{cabinet}}).empty()) << "the drawer is gone";
}

}  // namespace
}  // namespace ovimap
