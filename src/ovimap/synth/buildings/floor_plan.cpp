// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/buildings/floor_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"
#include "ovimap/synth/buildings/room_builder.h"
#include "ovimap/synth/camera/walk.h"
#include "ovimap/synth/procedural/made_model.h"
#include "ovimap/synth/shapes/mesh_parts.h"
#include "ovimap/synth/shapes/random.h"

namespace ovimap {
namespace {

constexpr std::uint64_t kRoomStream = 7001;
constexpr int kFurnishings = 30;   // ways to furnish a room that are tried
constexpr float kInside_m = 0.5f;  // of a doorway: where one stands who came through it
constexpr float kDoorFrame_m = 0.03f, kFrameProud_m = 0.01f;
constexpr float kThreshold_m = 0.004f;
constexpr float kLeafThickness_m = 0.045f, kLeafGap_m = 0.006f;
constexpr float kLeafOpen_rad[] = {1.35f, 1.55f};
constexpr float kFaintLight = 0.02f;
constexpr float kTouching_m = 1e-3f;
const Eigen::Vector3f kFrameColor(0.62f, 0.58f, 0.52f);

Eigen::AlignedBox2f floor_of(const PlanRoom& room) {
  return {room.origin_m, Eigen::Vector2f(room.origin_m + room.spec.size_m.head<2>())};
}

/// The wall of `room` that faces `other` across the plan's walls; nothing where none does.
std::optional<std::size_t> wall_towards(const PlanRoom& room, const PlanRoom& other) {
  const Eigen::Vector2f low = floor_of(room).min(), high = floor_of(room).max();
  const Eigen::Vector2f other_low = floor_of(other).min(), other_high = floor_of(other).max();
  const float gaps[] = {low.y() - other_high.y(), other_low.x() - high.x(),
                        other_low.y() - high.y(), low.x() - other_high.x()};
  for (std::size_t wall = 0; wall < std::size(gaps); ++wall)
    if (std::abs(gaps[wall] - kPlanWall_m) < kTouching_m) return wall;
  return std::nullopt;
}

Doorway doorway_in(const PlanRoom& room, std::size_t wall, const PlanDoor& door) {
  const WallLine line = wall_lines(room.spec.size_m.head<2>())[wall];
  const int axis = wall % 2 == 0 ? 0 : 1;
  const float local_m = door.at_m - room.origin_m[axis];
  const float center_m = (local_m - line.start_m[axis]) * line.along[axis];
  if (center_m < door.width_m / 2 || center_m > line.length_m - door.width_m / 2)
    throw Error(concat("door at ", door.at_m, " m: the ", line.name, " of room '", room.spec.name,
                       "' ends before it"));
  return {wall, center_m, door.width_m, door.height_m};
}

/// The plan's rooms with their doorways, and windows only in outer walls.
std::vector<PlanRoom> with_doorways(const FloorPlan& plan) {
  std::vector<PlanRoom> rooms = plan.rooms;
  for (const PlanDoor& door : plan.doors)
    for (const auto& [a, b] : {std::pair{door.first, door.second}, {door.second, door.first}}) {
      const auto wall = wall_towards(plan.rooms.at(a), plan.rooms.at(b));
      if (!wall)
        throw Error(concat("door between '", plan.rooms[a].spec.name, "' and '",
                           plan.rooms[b].spec.name, "': their walls are not ", kPlanWall_m,
                           " m apart"));
      rooms[a].spec.doorways.push_back(doorway_in(plan.rooms[a], *wall, door));
    }
  Eigen::AlignedBox2f whole;
  for (const PlanRoom& room : rooms) whole.extend(floor_of(room));
  for (PlanRoom& room : rooms) {
    const Eigen::AlignedBox2f floor = floor_of(room);
    room.spec.may_have_windows = {floor.min().y() - whole.min().y() < kTouching_m,
                                  whole.max().x() - floor.max().x() < kTouching_m,
                                  whole.max().y() - floor.max().y() < kTouching_m,
                                  floor.min().x() - whole.min().x() < kTouching_m};
  }
  return rooms;
}

/// Furnishes a room so that one can walk from each of its doors to every other.
SynthRoom walkable_room(RoomSpec spec, const FloorPlan& plan, std::size_t number,
                        const std::filesystem::path& furniture, const LayoutConfig& config) {
  for (int i = 0; i < kFurnishings; ++i) {
    spec.seed =
        Random(Random(plan.seed, kRoomStream + number).bits(), static_cast<std::uint64_t>(i))
            .bits();
    SynthRoom room = build_room(spec, furniture, config);
    std::vector<Eigen::Vector2f> entries;
    for (const Doorway& doorway : spec.doorways)
      entries.push_back(doorway_box(spec, doorway, 2 * kInside_m).center_m);
    if (all_reachable(room, {}, entries)) return room;
  }
  throw Error(concat("room '", spec.name, "' of plan '", plan.name, "' (seed ", plan.seed,
                     "): its furniture leaves no way between its doors; choose another seed"));
}

void move(SynthRoom& room, const Eigen::Vector2f& by) {
  const Eigen::Vector3f shift(by.x(), by.y(), 0);
  for (RoomObject& object : room.objects) {
    for (Eigen::Vector3f& vertex : object.mesh.vertices) vertex += shift;
    object.box.translate(shift);
    if (object.footprint) object.footprint->center_m += by;
  }
  for (AreaLight& light : room.lights) light.center_m += shift;
}

/// The lining of an opening through both walls, with its threshold.
RoomObject door_frame(const PlanRoom& room, const Doorway& doorway) {
  const OrientedBox box = doorway_box(room.spec, doorway, -kPlanWall_m);
  const float x = box.half_m.x(), y = box.half_m.y() + kFrameProud_m, w = kDoorFrame_m;
  const float z = doorway.height_m;
  TexturedMesh mesh;
  SurfaceMaterial wood;
  wood.albedo = kFrameColor;
  const auto frame = add_material(mesh, wood);
  add_box(mesh, {-x, -y, 0}, {-x + w, y, z}, frame);
  add_box(mesh, {x - w, -y, 0}, {x, y, z}, frame);
  add_box(mesh, {-x + w, -y, z - w}, {x - w, y, z}, frame);
  add_box(mesh, {-x + w, -y, 0}, {x - w, y, kThreshold_m}, frame);
  OrientedBox place = box;
  place.center_m += room.origin_m;
  place.half_m.y() = y;
  RoomObject object;
  object.name = "door frame";
  object.class_name = "door";
  object.room = room.spec.name;
  object.mesh = placed_mesh(mesh, place);
  object.box = bounds(object.mesh);
  return object;
}

/// A leaf that stands open in the room, beside its doorway: a thing of its own, with handles.
RoomObject door_leaf(const PlanRoom& room, const Doorway& doorway, std::uint64_t seed) {
  Random random(seed);
  const float width = doorway.width_m - 2 * kDoorFrame_m - kLeafGap_m;
  const float height = doorway.height_m - kDoorFrame_m - kLeafGap_m;
  RoomObject object;
  object.name = object.class_name = "door";
  object.room = room.spec.name;
  MadeModel model = make_model("door leaf", room.spec.split, random);
  OrientedBox place = doorway_box(room.spec, doorway, 0);
  const Eigen::Vector2f hinge =
      place.world_from_box({-place.half_m.x() + kDoorFrame_m + kLeafThickness_m, -kFrameProud_m});
  object.hinge = {hinge + room.origin_m, place.yaw_rad};
  place.yaw_rad -= random.uniform(kLeafOpen_rad[0], kLeafOpen_rad[1]);
  place.half_m = {width / 2, kLeafThickness_m / 2};
  place.center_m = hinge + room.origin_m;
  place.center_m = place.world_from_box({width / 2, -kLeafThickness_m / 2});
  place.bottom_m = kThreshold_m + kLeafGap_m;
  place.top_m = height;
  object.mesh = placed_mesh(model.mesh, place);
  object.box = bounds(object.mesh);
  object.footprint = place;
  return object;
}

/// The walls of a room as a body meets them: without its doorways.
std::vector<OrientedBox> walls_of(const PlanRoom& room) {
  std::vector<OrientedBox> boxes;
  const auto lines = wall_lines(room.spec.size_m.head<2>());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::vector<std::array<float, 2>> gaps = {{lines[i].length_m, lines[i].length_m}};
    for (const Doorway& doorway : room.spec.doorways)
      if (doorway.wall == i)
        gaps.push_back({doorway.center_m - doorway.width_m / 2 + kDoorFrame_m,
                        doorway.center_m + doorway.width_m / 2 - kDoorFrame_m});
    std::sort(gaps.begin(), gaps.end());
    float from_m = 0;
    for (const auto& [begin_m, end_m] : gaps) {
      const Eigen::Vector2f middle = lines[i].start_m + (from_m + begin_m) / 2 * lines[i].along -
                                     kPlanWall_m / 4 * lines[i].inward;
      boxes.push_back({room.origin_m + middle,
                       {(begin_m - from_m) / 2, kPlanWall_m / 4},
                       yaw_facing(lines[i].inward),
                       0,
                       room.spec.size_m.z()});
      from_m = end_m;
    }
  }
  return boxes;
}

void add_room(const PlanRoom& room, SynthRoom furnished, SynthRoom& all) {
  move(furnished, room.origin_m);
  all.zones.push_back({room.spec.name, floor_of(room)});
  for (RoomObject& object : furnished.objects) {
    object.room = room.spec.name;
    all.objects.push_back(std::move(object));
  }
  all.lights.insert(all.lights.end(), furnished.lights.begin(), furnished.lights.end());
  for (const OrientedBox& wall : walls_of(room)) all.walls.push_back(wall);
  all.ambient = furnished.ambient;
  const Eigen::Vector2f reach = floor_of(room).max();
  all.size_m = all.size_m.cwiseMax(Eigen::Vector3f(reach.x(), reach.y(), room.spec.size_m.z()));
}

}  // namespace

SynthRoom build_plan(const FloorPlan& plan, const std::filesystem::path& furniture_folder,
                     const LayoutConfig& config) {
  const std::vector<PlanRoom> rooms = with_doorways(plan);
  SynthRoom all;
  all.name = plan.name;
  all.seed = plan.seed;
  all.faint_light = kFaintLight;
  std::vector<SynthRoom> furnished(rooms.size());
  parallel_for(rooms.size(), 1, [&](std::size_t i) {
    furnished[i] = walkable_room(rooms[i].spec, plan, i, furniture_folder, config);
  });
  for (std::size_t i = 0; i < rooms.size(); ++i) add_room(rooms[i], std::move(furnished[i]), all);
  std::vector<std::size_t> used(rooms.size(), 0);
  for (const PlanDoor& door : plan.doors) {  // a room's doorways are in the order of the doors
    const Doorway& doorway = rooms[door.first].spec.doorways[used[door.first]];
    all.objects.push_back(door_frame(rooms[door.first], doorway));
    if (door.has_leaf) {
      const Doorway& opens_into = rooms[door.second].spec.doorways[used[door.second]];
      all.objects.push_back(
          door_leaf(rooms[door.second], opens_into, plan.seed + all.objects.size()));
    }
    ++used[door.first], ++used[door.second];
  }
  for (std::size_t i = 0; i < all.objects.size(); ++i)
    all.objects[i].id = static_cast<std::uint16_t>(i + 1);
  return all;
}

}  // namespace ovimap
