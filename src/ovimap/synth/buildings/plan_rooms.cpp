// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/buildings/plan_rooms.h"

#include <algorithm>
#include <set>

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"
#include "ovimap/synth/buildings/floor_plan.h"
#include "ovimap/synth/buildings/office_building.h"

namespace ovimap {
namespace {

using enum Placement;
using Classes = std::vector<std::string>;

constexpr float kPlanHeight_m = 2.5f;
constexpr int kBuildingRooms = 10;  // each way

/// Doors are the plan's own; these would stand in the way.
const std::set<std::string>& left_out() {
  static const std::set<std::string> classes = {
      "door",       "piano",        "rocking horse",  "dollhouse",
      "whiteboard", "water cooler", "filing cabinet", "box",
      "suitcase",   "guitar",       "stool",          "shower",
      "rug"};
  return classes;
}

RoomSpec hall() {
  RoomSpec spec;
  spec.wall_color = {224, 222, 216};
  spec.accent_color = {206, 200, 186};
  spec.furniture = {{"cabinet", kAgainstWall, 1, {}, "BlendSwap-CC-0/shelves"},
                    {"plant", kInCorner, 1, {}, "BlendSwap-CC-0/decorativePlant"},
                    {"shoes", kOnFloor, 1, {}, "Scopia/sneakers"},
                    {"backpack", kOnFloor},
                    {"telephone", kOnTop, 1, {"cabinet"}},
                    {"vase", kOnTop, 1, {"cabinet"}},
                    {"clock", kOnWall},
                    {"picture", kOnWall, 2},
                    {"ceiling lamp", kOnCeiling, 2}};
  return spec;
}

RoomSpec dining_room() {
  RoomSpec spec;
  spec.accent_style = "dots";
  spec.wall_color = {228, 220, 206};
  spec.accent_color = {190, 172, 150};
  const Classes table = {"table"}, low = {"cabinet"};
  spec.furniture = {{"window", kInWall},
                    {"cabinet", kAgainstWall, 1, {}, "BlendSwap-CC-BY/dresserWithDrawers"},
                    {"table", kInMiddle, 1, {}, "Scopia/white_kitchen_table"},
                    {"chair", kAround, 3, table, "BlendSwap-CC-BY/plaidChair"},
                    {"plant", kInCorner, 1, {}, "Scopia/maceta"},
                    {"stereo", kOnTop, 1, low},
                    {"photo frame", kOnTop, 1, low},
                    {"teapot", kOnTop, 1, table},
                    {"mug", kOnTop, 2, table},
                    {"bowl", kOnTop, 1, table},
                    {"radiator", kOnWall, 1, {}, "BlendSwap-CC-BY/modernRadiator", 0.12f},
                    {"picture", kOnWall, 2},
                    {"ceiling lamp", kOnCeiling}};
  return spec;
}

/// Where people meet: much floor, little furniture.
RoomSpec assembly_hall() {
  RoomSpec spec;
  spec.wall_color = {232, 230, 222};
  spec.accent_color = {176, 160, 136};
  const Classes table = {"table"}, low = {"cabinet"};
  spec.furniture = {{"window", kInWall, 4},
                    {"cabinet", kAgainstWall, 2, {}, "BlendSwap-CC-BY/dresserWithDrawers"},
                    {"table", kInMiddle, 2, {}, "Scopia/white_kitchen_table"},
                    {"chair", kAround, 6, table, "BlendSwap-CC-BY/plaidChair"},
                    {"plant", kInCorner, 2, {}, "Scopia/maceta"},
                    {"stereo", kOnTop, 1, low},
                    {"vase", kOnTop, 1, low},
                    {"bowl", kOnTop, 1, table},
                    {"backpack", kOnFloor},
                    {"radiator", kOnWall, 2, {}, "BlendSwap-CC-BY/modernRadiator", 0.12f},
                    {"picture", kOnWall, 5},
                    {"clock", kOnWall},
                    {"ceiling lamp", kOnCeiling, 6}};
  return spec;
}

RoomSpec lived_in(const std::string& kind) {
  if (kind == "hall") return hall();
  if (kind == "dining-room") return dining_room();
  if (kind == "assembly-hall") return assembly_hall();
  RoomSpec spec = room_spec(kind);
  std::erase_if(spec.furniture, [](const FurnitureRequest& request) {
    return left_out().count(request.class_name) > 0;
  });
  return spec;
}

PlanRoom at(const std::string& kind, float x, float y, float width, float depth) {
  return {plan_room(kind, {width, depth, kPlanHeight_m}), {x, y}};
}

/// Rooms north and south of a corridor.
FloorPlan flat() {
  FloorPlan plan;
  plan.rooms = {at("hall", 0, 4.32f, 9.42f, 1.7f), at("living-room", 0, 0, 5.2f, 4.2f),
                at("bedroom", 5.32f, 0, 4.1f, 4.2f), at("office", 6.3f, 6.14f, 3.12f, 3.4f),
                at("kitchen", 0, 6.14f, 6.18f, 3.4f)};
  plan.doors = {{0, 1, 3.4f}, {0, 2, 6.2f}, {0, 3, 7.2f}, {0, 4, 4.4f}};
  return plan;
}

/// Three by three rooms without the one in the middle, each joined to the next.
FloorPlan loop() {
  constexpr float kSide = 4.2f, kMiddle = 3.2f, kDeep = 3.7f, kShallow = 3.f;
  constexpr float kX1 = kSide + kPlanWall_m, kX2 = kX1 + kMiddle + kPlanWall_m;
  constexpr float kY1 = kDeep + kPlanWall_m, kY2 = kY1 + kShallow + kPlanWall_m;
  FloorPlan plan;
  plan.rooms = {at("living-room", 0, 0, kSide, kDeep), at("hall", kX1, 0, kMiddle, kDeep),
                at("kitchen", kX2, 0, kSide, kDeep),   at("dining-room", kX2, kY1, kSide, kShallow),
                at("office", kX2, kY2, kSide, kDeep),  at("bathroom", kX1, kY2, kMiddle, kDeep),
                at("bedroom", 0, kY2, kSide, kDeep),   at("dining-room", 0, kY1, kSide, kShallow)};
  plan.rooms[7].spec.name = "breakfast-room";
  plan.doors = {{0, 1, 1.8f},       {1, 2, 1.8f},       {2, 3, kX2 + 2.1f}, {3, 4, kX2 + 2.1f},
                {4, 5, kY2 + 1.8f}, {5, 6, kY2 + 1.8f}, {6, 7, 2.1f},       {7, 0, 2.1f}};
  return plan;
}

/// One large and high room, and the lobby before it.
FloorPlan assembly_rooms() {
  constexpr float kHallHeight_m = 3.6f, kHallDepth_m = 8.4f;
  FloorPlan plan;
  plan.rooms = {at("hall", 4, 0, 4, 2), {{}, {0, 2 + kPlanWall_m}}};
  plan.rooms[1].spec = plan_room("assembly-hall", {12, kHallDepth_m, kHallHeight_m});
  plan.doors = {{0, 1, 6}};
  return plan;
}

}  // namespace

RoomSpec plan_room(const std::string& kind, const Eigen::Vector3f& size_m) {
  RoomSpec spec = lived_in(kind);
  spec.name = kind;
  spec.size_m = size_m;
  return spec;
}

std::vector<std::string> floor_plan_names() {
  return {"flat", "loop", "hall", "building"};
}

FloorPlan floor_plan(const std::string& name, std::uint64_t seed) {
  FloorPlan plan;
  if (name == "flat")
    plan = flat();
  else if (name == "loop")
    plan = loop();
  else if (name == "hall")
    plan = assembly_rooms();
  else if (name == "building")
    plan = office_building(kBuildingRooms, kBuildingRooms);
  else
    throw Error(concat("plan '", name, "': no such floor plan, did you mean '",
                       nearest_word(name, floor_plan_names()), "'?"));
  plan.name = name;
  plan.seed = seed;
  return plan;
}

}  // namespace ovimap
