// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/map_diff.h"

#include <gtest/gtest.h>

#include "ovimap/pipeline/mapping/furnished_fixture.h"
#include "ovimap/pipeline/report/change_mesh.h"

namespace ovimap {
namespace {

const Furniture kChest = furniture(-0.9f, 0.9f, {0.6f, 0.4f, 0.5f}, {190, 120, 40});
const Furniture kRedBox = furniture(0.6f, 0.3f, {0.3f, 0.3f, 0.3f}, {220, 20, 20});
const Furniture kRedBoxAway = furniture(-0.7f, -0.7f, {0.3f, 0.3f, 0.3f}, {220, 20, 20});
const Furniture kBlueBox = furniture(0.2f, -0.9f, {0.35f, 0.25f, 0.4f}, {20, 30, 220});
const Furniture kGreenBox = furniture(1.0f, -0.5f, {0.3f, 0.4f, 0.25f}, {20, 200, 30});

const ObjectChange* change_of(const std::vector<ObjectChange>& changes, InstanceId before,
                              InstanceId after) {
  for (const ObjectChange& change : changes)
    if ((before != 0 && change.before == before) || (after != 0 && change.after == after))
      return &change;
  return nullptr;
}

class MapDiffTest : public ::testing::Test {
 protected:
  static MapDocument room_with(std::vector<Furniture> things,
                               const Pose& world_from_room = Pose::Identity()) {
    FurnishedRoom room;
    room.things = std::move(things);
    room.world_from_room = world_from_room;
    return map_of(room);
  }
  static InstanceId at(const MapRecord& map, const Furniture& thing,
                       const Pose& room_from_world = Pose::Identity()) {
    const Eigen::Vector3f center = thing.box.center();
    return object_at(map, room_from_world, center.x(), center.y(), thing.box.max().z() * 0.7f);
  }
};

TEST_F(MapDiffTest, TellsWhatMovedWentAndCame) {
  Pose after_from_room(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()));
  after_from_room.translation() = Eigen::Vector3d(0.3, -0.2, 0.1);
  const MapDocument before = room_with({kChest, kRedBox, kBlueBox}),
                    after = room_with({kChest, kRedBoxAway, kGreenBox}, after_from_room);
  const auto changes = diff_maps(before, after, after_from_room.inverse());
  const Pose room_from_after = after_from_room.inverse();

  const ObjectChange* chest = change_of(changes, at(before, kChest), 0);
  ASSERT_NE(chest, nullptr);
  EXPECT_EQ(chest->kind, ChangeKind::kSame) << chest->evidence;
  EXPECT_EQ(chest->after, at(after, kChest, room_from_after));
  EXPECT_GT(chest->overlap, 0.5f);

  const ObjectChange* red = change_of(changes, at(before, kRedBox), 0);
  ASSERT_NE(red, nullptr);
  EXPECT_EQ(red->kind, ChangeKind::kMoved) << red->evidence;
  EXPECT_EQ(red->after, at(after, kRedBoxAway, room_from_after));
  EXPECT_NEAR(red->shift_m.x(), -1.3f, 0.06f);
  EXPECT_NEAR(red->shift_m.y(), -1.0f, 0.06f);
  EXPECT_GT(*red->cosine, 0.9f);

  const ObjectChange* blue = change_of(changes, at(before, kBlueBox), 0);
  ASSERT_NE(blue, nullptr);
  EXPECT_EQ(blue->kind, ChangeKind::kRemoved) << blue->evidence;
  EXPECT_EQ(blue->after, 0u);
  EXPECT_GT(blue->seen_through, 0.5f);

  const ObjectChange* green = change_of(changes, 0, at(after, kGreenBox, room_from_after));
  ASSERT_NE(green, nullptr);
  EXPECT_EQ(green->kind, ChangeKind::kNew) << green->evidence;

  for (const ObjectChange& change : changes) {
    if (&change == red || &change == blue || &change == green) continue;
    EXPECT_EQ(change.kind, ChangeKind::kSame)
        << change.before << " " << change.after << ": " << change.evidence;
  }
  const Mesh picture = change_mesh(before, after, after_from_room.inverse(), changes);
  std::set<std::array<std::uint8_t, 3>> bright;
  for (const auto& color : picture.colors)
    if (color[0] != color[1] || color[1] != color[2]) bright.insert(color);
  EXPECT_EQ(bright.size(), 4u);  // new, moved, where it was, removed
}

TEST_F(MapDiffTest, WhereTheOtherDidNotLookNothingIsSaid) {
  FurnishedRoom half;
  half.things = {kChest};
  half.first_turn = 0.1;
  half.last_turn = 0.13;  // looks from the far right to the left
  half.frames = 6;
  FurnishedRoom full;
  full.things = {kChest, furniture(1.8f, 1.4f, {0.3f, 0.3f, 0.4f}, {200, 200, 20})};
  const MapDocument before = map_of(full), after = map_of(half);
  const InstanceId corner = object_at(before, Pose::Identity(), 1.8f, 1.4f, 0.3f);
  ASSERT_NE(corner, 0u);
  const auto changes = diff_maps(before, after, Pose::Identity());
  const ObjectChange* change = change_of(changes, corner, 0);
  ASSERT_NE(change, nullptr);
  EXPECT_EQ(change->kind, ChangeKind::kUnseen) << change->evidence;
}

TEST_F(MapDiffTest, ASmallShiftIsSeen) {
  const Furniture nudged = furniture(0.72f, 0.3f, {0.3f, 0.3f, 0.3f}, {220, 20, 20});
  const MapDocument before = room_with({kChest, kRedBox}), after = room_with({kChest, nudged});
  const auto changes = diff_maps(before, after, Pose::Identity());
  const ObjectChange* red = change_of(changes, at(before, kRedBox), 0);
  ASSERT_NE(red, nullptr);
  EXPECT_EQ(red->kind, ChangeKind::kMoved) << red->evidence;
  EXPECT_NEAR(red->shift_m.norm(), 0.12f, 0.03f);
}

TEST_F(MapDiffTest, WhatComesToWhereRemainsLieIsNewAndNotThem) {
  MapDocument before = room_with({kChest});
  const MapDocument after = room_with({kChest, kRedBox});
  const InstanceId red = at(after, kRedBox);
  ASSERT_NE(red, 0u);
  // A few points of something that had stood there and left them behind.
  const std::vector<Eigen::Vector3f>& surface = after.surfaces.at(red);
  InstanceSummary remains = before.instances.front();
  remains.id = before.instances.back().id + 1;
  before.instances.push_back(remains);
  before.surfaces[remains.id] = {surface.begin(), surface.begin() + 8};
  const auto changes = diff_maps(before, after, Pose::Identity());
  const ObjectChange* come = change_of(changes, 0, red);
  ASSERT_NE(come, nullptr);
  EXPECT_EQ(come->kind, ChangeKind::kNew) << come->evidence;
  EXPECT_EQ(come->before, 0u);
  EXPECT_EQ(change_of(changes, remains.id, 0)->after, 0u);
}

TEST_F(MapDiffTest, AMapIsTheSameAsItself) {
  const MapDocument map = room_with({kChest, kRedBox, kBlueBox});
  for (const ObjectChange& change : diff_maps(map, map, Pose::Identity())) {
    EXPECT_EQ(change.kind, ChangeKind::kSame) << change.evidence;
    EXPECT_EQ(change.before, change.after);
  }
}

}  // namespace
}  // namespace ovimap
