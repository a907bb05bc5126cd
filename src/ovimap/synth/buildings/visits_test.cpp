// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/buildings/visits.h"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "ovimap/synth/buildings/room_builder.h"
#include "ovimap/synth/rooms/room_spec.h"
#include "ovimap/synth/shapes/mesh_parts.h"

namespace ovimap {
namespace {

/// A room of boxes: a table with two things on it, and six stools.
SynthRoom boxes_room() {
  SynthRoom room;
  room.name = "boxes";
  room.seed = 3;
  room.size_m = {4, 4, 2.5f};
  const auto add = [&](const std::string& name, OrientedBox box) {
    RoomObject object;
    object.name = object.class_name = name;
    add_box(object.mesh, {-1, -1, 0}, {1, 1, 1}, add_material(object.mesh, {}));
    object.mesh = placed_mesh(object.mesh, box);
    object.box = bounds(object.mesh);
    object.footprint = box;
    object.id = static_cast<std::uint16_t>(room.objects.size() + 1);
    room.objects.push_back(std::move(object));
  };
  add("table", {{1, 1}, {0.6f, 0.4f}, 0.3f, 0, 0.7f});
  add("jug", {{1.2f, 1}, {0.06f, 0.06f}, 0, 0.7005f, 0.9f});
  add("vase", {{0.8f, 1}, {0.06f, 0.06f}, 0, 0.7005f, 0.95f});
  add("picture", {{2, 3.98f}, {0.3f, 0.01f}, 0, 1.4f, 1.8f});
  for (int i = 0; i < 6; ++i)
    add("stool", {{0.4f + 0.6f * static_cast<float>(i), 3}, {0.2f, 0.2f}, 0, 0, 0.5f});
  return room;
}

TEST(Visits, ChangesAreThoseBetweenTheRooms) {
  const std::vector<Visit> visits = plan_visits(boxes_room(), 3);
  ASSERT_EQ(visits.size(), 3u);
  EXPECT_TRUE(visits[0].changes.empty());
  for (std::size_t i = 1; i < visits.size(); ++i) {
    std::map<std::uint16_t, RoomChange> changes;
    for (const RoomChange& change : visits[i].changes) changes[change.object] = change;
    EXPECT_EQ(changes.size(), 5u) << "three moved, one removed, one added";
    for (std::size_t k = 0; k < visits[i].room.objects.size(); ++k) {
      const RoomObject &before = visits[i - 1].room.objects[k], &now = visits[i].room.objects[k];
      EXPECT_EQ(now.id, k + 1);
      const auto change = changes.find(now.id);
      if (change == changes.end()) {
        EXPECT_EQ(now.mesh.vertices, before.mesh.vertices) << now.name;
        continue;
      }
      const RoomChange& told = change->second;
      EXPECT_EQ(told.from.isEmpty(), before.mesh.vertices.empty());
      EXPECT_EQ(told.to.isEmpty(), now.mesh.vertices.empty());
      if (told.kind != RoomChangeKind::kMoved) continue;
      EXPECT_GT((told.to.center() - told.from.center()).norm(), 0.3f);
      for (std::size_t v = 0; v < now.mesh.vertices.size(); ++v)
        EXPECT_LT((told.new_from_old.cast<float>() * before.mesh.vertices[v] - now.mesh.vertices[v])
                      .norm(),
                  1e-4f);
    }
  }
}

TEST(Visits, ThingsGoWhereThereIsRoomAndWhatCarriesOthersStays) {
  for (const Visit& visit : plan_visits(boxes_room(), 6)) {
    const auto& objects = visit.room.objects;
    for (const RoomChange& change : visit.changes)
      EXPECT_NE(objects[change.object - 1u].name, "picture");
    for (const RoomObject& a : objects)
      for (const RoomObject& b : objects)
        if (a.id < b.id && a.footprint && b.footprint) {
          EXPECT_LE(overlap(*a.footprint, *b.footprint), 1e-3f) << a.name << " in " << b.name;
        }
    for (const RoomObject& object : objects)
      if (object.footprint && (object.name == "jug" || object.name == "vase")) {
        EXPECT_GT(object.footprint->bottom_m, 0.45f) << "things of tables stay off the floor";
      }
  }
}

TEST(Visits, DoorsTurnAboutTheirHingesAndStayOpen) {
  SynthRoom room = boxes_room();
  RoomObject door = room.objects.front();
  door.name = "door";
  door.id = static_cast<std::uint16_t>(room.objects.size() + 1);
  door.hinge = {{2.6f, 1.6f}, 0};
  const OrientedBox shut = {{3, 1.58f}, {0.4f, 0.02f}, 0, 0.01f, 2};
  door.footprint = shut.turned(door.hinge->at_m, -1.4f);
  room.objects.push_back(door);
  int turns = 0;
  const std::vector<Visit> visits = plan_visits(room, 6);
  for (std::size_t i = 1; i < visits.size(); ++i)
    for (const RoomChange& change : visits[i].changes) {
      if (change.object != door.id) continue;
      ++turns;
      EXPECT_EQ(change.kind, RoomChangeKind::kMoved);
      const OrientedBox &was = *visits[i - 1].room.objects[door.id - 1u].footprint,
                        &is = *visits[i].room.objects[door.id - 1u].footprint;
      EXPECT_GE(std::abs(is.yaw_rad - was.yaw_rad), 0.45f);
      EXPECT_LE(is.yaw_rad, -0.9f) << "one can walk through";
      EXPECT_GE(is.yaw_rad, -1.65f);
      const Eigen::Vector3d hinge(2.6, 1.6, 1);
      EXPECT_LT((change.new_from_old * hinge - hinge).norm(), 1e-3);
    }
  EXPECT_GE(turns, 3);
}

TEST(Visits, TheSameSeedGivesTheSameVisits) {
  const SynthRoom room = boxes_room();
  const std::vector<Visit> once = plan_visits(room, 4), again = plan_visits(room, 4);
  SynthRoom other = room;
  other.seed = 4;
  const std::vector<Visit> different = plan_visits(other, 4);
  bool same_as_other = true;
  for (std::size_t i = 0; i < once.size(); ++i)
    for (std::size_t k = 0; k < room.objects.size(); ++k) {
      EXPECT_EQ(once[i].room.objects[k].mesh.vertices, again[i].room.objects[k].mesh.vertices);
      same_as_other = same_as_other && once[i].room.objects[k].mesh.vertices ==
                                           different[i].room.objects[k].mesh.vertices;
    }
  EXPECT_FALSE(same_as_other);
}

TEST(Visits, ARoomWithNothingFreeStaysAsItIs) {
  SynthRoom room = build_room(room_spec("bare"));
  for (const Visit& visit : plan_visits(room, 3)) EXPECT_TRUE(visit.changes.empty());
}

}  // namespace
}  // namespace ovimap
