// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/buildings/office_building.h"

#include "ovimap/base/error.h"
#include "ovimap/synth/buildings/made_requests.h"

namespace ovimap {
namespace {

using enum Placement;

constexpr float kWidth_m = 7.2f, kDepth_m = 7.f, kCeiling_m = 2.7f;
constexpr float kDoor_m = 1.6f;  // middle of the doors, from a room's south or west wall
constexpr float kWallShelfBottom_m = 1.4f;

void office(RoomSpec& spec) {
  const Names desk = {"desk"};
  spec.furniture = {made("desk", kAgainstWall, 5),      made("bookshelf", kAgainstWall, 2),
                    made("cabinet", kAgainstWall),      made("chair", kAround, 5, desk),
                    made("monitor", kOnTop, 5, desk),   made("lamp", "desk lamp", kOnTop, 3, desk),
                    made("box", "basket", kOnFloor, 2), made("plant", kInCorner)};
  spec.clutter = {{desk, all_made({"keyboard"}), 1, 1},
                  {desk, all_made({"mouse"}), 1, 1},
                  {desk, all_made({"paper", "book", "notebook", "folder", "envelope"}), 6, 9},
                  {desk,
                   all_made({"phone", "mug", "calculator", "cable", "stapler", "charger", "glasses",
                             "headphones", "pen holder", "tape", "desk calendar", "ruler",
                             "scissors", "tablet"}),
                   8, 12},
                  {{"bookshelf"}, all_made({"standing book"}), 3, 8},
                  {{"cabinet"}, all_made({"potted plant", "photo stand", "box", "vase"}), 3, 5}};
}

void library(RoomSpec& spec) {
  const Names table = {"table"};
  spec.furniture = {made("bookshelf", kAgainstWall, 8), made("table", kInMiddle),
                    made("chair", kAround, 4, table), made("armchair", kInCorner, 2),
                    made("floor lamp", kInCorner)};
  spec.clutter = {{{"bookshelf"}, all_made({"standing book"}), 3, 7},
                  {{"bookshelf"}, all_made({"photo stand", "vase", "box", "book"}), 0, 1},
                  {table, all_made({"book", "magazine", "paper", "glasses", "notebook"}), 8, 12}};
}

void canteen(RoomSpec& spec) {
  const Names table = {"table"}, counter = {"kitchen cabinet"};
  spec.furniture = {made("refrigerator", kAgainstWall),
                    made("kitchen cabinet", "kitchen counter", kAgainstWall, 4),
                    made("stove", kAgainstWall),
                    made("table", kOnFloor, 4),
                    made("chair", kAround, 10, table),
                    made("shelf", "wall shelf", kOnWall, 3, {}, kWallShelfBottom_m)};
  spec.clutter = {
      {counter, all_made({"kettle", "pot", "bottle", "can", "carton", "tissue box"}), 8, 12},
      {table, all_made({"mug", "plate", "bowl", "glass", "bottle", "cutlery"}), 18, 24},
      {table, all_made({"place mat", "magazine", "keys", "phone"}), 2, 4},
      {{"shelf"}, all_made({"can", "carton", "mug", "glass", "bottle"}), 5, 8}};
}

void store(RoomSpec& spec) {
  spec.furniture = {made("bookshelf", kAgainstWall, 8), made("table", kInMiddle),
                    made("box", kOnFloor, 3), made("box", "basket", kOnFloor, 2)};
  spec.clutter = {
      {{"bookshelf"},
       all_made({"box", "can", "carton", "bottle", "folder", "tape", "tissue box", "pot"}),
       5,
       8},
      {{"table"}, all_made({"box", "tape", "scissors", "paper", "carton"}), 8, 12}};
}

void lounge(RoomSpec& spec) {
  const Names seats = {"sofa", "armchair"}, low = {"coffee table"};
  spec.furniture = {made("sofa", kAgainstWall, 2),
                    made("tv stand", kAgainstWall),
                    made("cabinet", kAgainstWall, 4),
                    made("bookshelf", kAgainstWall, 2),
                    made("coffee table", kInMiddle),
                    made("coffee table", kOnFloor),
                    made("armchair", kInCorner, 2),
                    made("tv", kOnTop, 1, {"tv stand"}),
                    made("pillow", "cushion", kOnTop, 6, seats),
                    made("shelf", "wall shelf", kOnWall, 4, {}, kWallShelfBottom_m),
                    made("plant", kInCorner)};
  spec.clutter = {
      {low, all_made({"book", "magazine", "mug", "bowl", "remote control", "game pad"}), 8, 12},
      {{"cabinet", "tv stand"},
       all_made({"photo stand", "vase", "potted plant", "box", "bottle", "keys"}),
       8,
       12},
      {{"bookshelf"}, all_made({"standing book"}), 3, 8},
      {{"shelf"}, all_made({"box", "book", "vase", "can", "mug"}), 5, 8}};
}

struct Kind {
  const char* name;
  void (*furnish)(RoomSpec&);
};
constexpr Kind kKinds[] = {{"office", office},
                           {"library", library},
                           {"canteen", canteen},
                           {"store", store},
                           {"lounge", lounge}};

RoomSpec room_of(int number) {
  const Kind& kind = kKinds[static_cast<std::size_t>(number) % std::size(kKinds)];
  RoomSpec spec;
  spec.name = concat(kind.name, " ", number + 1);
  spec.size_m = {kWidth_m, kDepth_m, kCeiling_m};
  spec.floor_style = "oak";
  spec.wall_color = {230, 228, 222};
  kind.furnish(spec);
  spec.furniture.push_back(made("picture", kOnWall, 4));
  spec.furniture.push_back(made("ceiling lamp", kOnCeiling, 2));
  return spec;
}

}  // namespace

FloorPlan office_building(int across, int deep) {
  if (across < 1 || deep < 1)
    throw Error(concat("a building of ", across, " x ", deep, " rooms: it needs one each way"));
  FloorPlan plan;
  plan.name = "building";
  const float step_x = kWidth_m + kPlanWall_m, step_y = kDepth_m + kPlanWall_m;
  std::size_t first_of_row = 0;
  for (int row = 0; row < deep; ++row)
    for (int i = 0; i < across; ++i) {
      const int column = row % 2 == 0 ? i : across - 1 - i;  // as one walks
      const std::size_t number = plan.rooms.size();
      const Eigen::Vector2f origin(step_x * static_cast<float>(column),
                                   step_y * static_cast<float>(row));
      plan.rooms.push_back({room_of(static_cast<int>(number)), origin});
      if (i > 0)
        plan.doors.push_back({number - 1, number, origin.y() + kDoor_m});
      else if (row > 0)
        plan.doors.push_back({number - 1, number, origin.x() + kDoor_m});
      if (column > 0) continue;
      if (row > 0 && i > 0) plan.doors.push_back({first_of_row, number, kDoor_m});  // the way back
      first_of_row = number;
    }
  return plan;
}

}  // namespace ovimap
