// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/buildings/floor_plan.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "ovimap/base/error.h"
#include "ovimap/synth/buildings/office_building.h"
#include "ovimap/synth/camera/small_camera_fixture.h"
#include "ovimap/synth/furniture/furniture_palette.h"
#include "ovimap/synth/recordings/sequence.h"

namespace ovimap {
namespace {

using fixture::kSmallCamera;

PlanRoom empty_room(const std::string& name, const Eigen::Vector2f& origin) {
  PlanRoom room;
  room.spec.name = name;
  room.spec.size_m = {4, 3, 2.5f};
  room.origin_m = origin;
  return room;
}

/// Two empty rooms side by side, a door between them; needs no furniture.
FloorPlan two_rooms() {
  FloorPlan plan;
  plan.name = "pair";
  plan.rooms = {empty_room("left", {0, 0}), empty_room("right", {4 + kPlanWall_m, 0})};
  plan.doors = {{0, 1, 1.2f}};
  return plan;
}

TEST(FloorPlanTest, OneSeesAndWalksThroughItsDoors) {
  const SynthRoom scene = build_plan(two_rooms());
  const RayScene rays(scene.objects);
  const auto object_at = [&](const Eigen::Vector3d& direction) {
    const auto hit = rays.trace({1, 1.2, 1}, direction);
    return hit ? &scene.objects[hit->object] : nullptr;
  };
  EXPECT_EQ(object_at({1, 0, 0})->room, "right");
  EXPECT_EQ(object_at({1, 0, 0})->name, "east wall");
  EXPECT_EQ(object_at({1, 0.3, 0})->room, "left");          // beside the door
  EXPECT_EQ(object_at({1, 0, 0.4})->room, "left");          // above it
  EXPECT_EQ(object_at({3, 0.44, 0})->class_name, "door");   // its frame
  EXPECT_EQ(object_at({3.06, 0, -1})->class_name, "door");  // its threshold
  const WalkConfig walk;
  EXPECT_TRUE(all_reachable(scene, walk, {{1, 1}, {7, 2}}));
  SynthRoom shut = scene;
  shut.walls.push_back({{4, 1.2f}, {0.1f, 0.5f}, 0, 0, 2});
  EXPECT_FALSE(all_reachable(shut, walk, {{1, 1}, {7, 2}}));
}

TEST(FloorPlanTest, NoRayLeavesIt) {
  VideoConfig video;
  video.walk.fps = 2;
  const SynthSequence sequence(build_plan(two_rooms()), kSmallCamera, video);
  ASSERT_GT(sequence.size(), 20);
  std::set<std::string> seen;
  for (std::int64_t i = 0; i < sequence.size(); ++i) {
    const IdImage ids = *sequence.truth_ids(i);
    for (const std::uint16_t id : ids) {
      ASSERT_GT(id, 0) << i;
      seen.insert(sequence.instances()[id - 1u].room);
    }
  }
  EXPECT_EQ(seen, (std::set<std::string>{"left", "right"}));
}

TEST(FloorPlanTest, DoorsThatJoinNothingAreSaid) {
  FloorPlan apart = two_rooms();
  apart.rooms[1].origin_m.x() += 0.5f;
  EXPECT_THROW(build_plan(apart), Error);
  FloorPlan beyond = two_rooms();
  beyond.doors[0].at_m = 2.9f;
  EXPECT_THROW(build_plan(beyond), Error);
  EXPECT_THROW(floor_plan("lop"), Error);
}

void expect_furnished_room_by_room(const SynthRoom& scene, const FloorPlan& plan, float most_m) {
  EXPECT_GE(scene.size_m.x(), 8);
  EXPECT_LE(scene.size_m.head<2>().maxCoeff(), most_m);
  ASSERT_EQ(scene.zones.size(), plan.rooms.size());
  for (const RoomZone& zone : scene.zones) {
    const Eigen::Vector2f low = zone.floor_m.min(), high = zone.floor_m.max();
    std::size_t furniture = 0;
    for (const RoomObject& object : scene.objects) {
      if (object.room != zone.name || object.name == "door frame") continue;
      furniture += object.footprint.has_value();
      EXPECT_GE(object.box.min().x(), low.x() - 1e-3f) << object.name;
      EXPECT_LE(object.box.max().y(), high.y() + 1e-3f) << object.name;
    }
    EXPECT_GE(furniture, 7u) << zone.name;
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    EXPECT_EQ(scene.objects[i].id, i + 1);
    EXPECT_GT(room_class_id(scene.objects[i].class_name), 0u);
  }
}

void expect_walk_through_every_room_and_back(const SynthRoom& scene, double least_m) {
  const WalkConfig config;
  const PlaneSpline path(walking_round(scene, config, 0.175), 0.25, true);
  EXPECT_GT(path.seconds() * config.speed_mps, least_m);
  std::set<std::string> entered;
  std::vector<OrientedBox> obstacles = scene.walls;
  for (const RoomObject& object : scene.objects)
    if (object.footprint && object.footprint->top_m > 0.1f &&
        object.footprint->bottom_m < config.eye_m)
      obstacles.push_back(*object.footprint);
  float least = 1;
  for (double t = 0; t < path.seconds(); t += 0.02) {
    const Eigen::Vector2f place = path.at(t).cast<float>();
    for (const RoomZone& zone : scene.zones)
      if (zone.floor_m.contains(place)) entered.insert(zone.name);
    const OrientedBox body{place, {0, 0}, 0, 0, 2};
    for (const OrientedBox& box : obstacles)
      if ((box.center_m - place).norm() < box.half_m.norm() + 1.5f * least)
        least = std::min(least, -footprint_overlap(box, body));
  }
  EXPECT_EQ(entered.size(), scene.zones.size());
  // Half the body's radius, less half a cell of the map and what bends of the spline cut off.
  EXPECT_GT(least, 0.05f);
  EXPECT_TRUE(path.at(0).isApprox(path.at(path.seconds()), 1e-9));
}

class FurnishedPlan : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(default_furniture_folder()))
      GTEST_SKIP() << "the Debian package sweethome3d-furniture is not installed";
  }
};

class NamedPlan : public FurnishedPlan, public testing::WithParamInterface<std::string> {};

TEST_P(NamedPlan, IsFurnishedAndItsWalkEntersEveryRoomKeepsClearAndComesBack) {
  const FloorPlan plan = floor_plan(GetParam());
  const SynthRoom scene = build_plan(plan);
  expect_furnished_room_by_room(scene, plan, 12);
  expect_walk_through_every_room_and_back(scene, GetParam() == "loop" ? 55 : 30);
}

TEST_F(FurnishedPlan, ABuildingHoldsManyThingsAndIsWalkedThrough) {
  const FloorPlan plan = office_building(3, 2);
  const SynthRoom scene = build_plan(plan);
  expect_furnished_room_by_room(scene, plan, 22);
  expect_walk_through_every_room_and_back(scene, 60);
  EXPECT_GT(scene.objects.size(), plan.rooms.size() * 150);
}

TEST(OfficeBuilding, OneWalksThroughTheRowsAndBackByTheFirstRooms) {
  const FloorPlan plan = floor_plan("building");
  ASSERT_EQ(plan.rooms.size(), 100u);
  std::set<std::string> names;
  std::set<std::pair<std::size_t, std::size_t>> joined;
  for (const PlanRoom& room : plan.rooms) names.insert(room.spec.name);
  for (const PlanDoor& door : plan.doors) joined.insert({door.first, door.second});
  EXPECT_EQ(names.size(), plan.rooms.size());
  for (std::size_t i = 0; i + 1 < plan.rooms.size(); ++i)
    EXPECT_TRUE(joined.count({i, i + 1})) << i;
  EXPECT_EQ(plan.rooms.back().origin_m.x(), 0);
  for (std::size_t first = 0; first < plan.rooms.size() - 10;
       first += 20)  // of two rows, there and back
    EXPECT_TRUE(joined.count({first, first + 19})) << first;
  EXPECT_THROW(office_building(0, 3), Error);
}

INSTANTIATE_TEST_SUITE_P(Every, NamedPlan, testing::Values("flat", "hall", "loop"),
                         [](const auto& plan) { return plan.param; });

}  // namespace
}  // namespace ovimap
