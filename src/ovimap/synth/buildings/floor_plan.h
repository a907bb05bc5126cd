// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ovimap/synth/furniture/furniture_catalog.h"
#include "ovimap/synth/rooms/room.h"
#include "ovimap/synth/rooms/room_layout.h"
#include "ovimap/synth/rooms/room_spec.h"

namespace ovimap {

inline constexpr float kPlanWall_m = 0.12f;  ///< thickness of the walls between rooms

/// A room and where its south-west corner is.
struct PlanRoom {
  RoomSpec spec;  ///< without doorways: the plan's doors make them
  Eigen::Vector2f origin_m = Eigen::Vector2f::Zero();
};

/// An open door between two rooms whose walls are kPlanWall_m apart.
struct PlanDoor {
  std::size_t first = 0, second = 0;  ///< numbers of the rooms
  float at_m = 0;                     ///< its middle along the wall: x or y on the plan
  float width_m = 0.9f, height_m = 2.05f;
  bool has_leaf = false;  ///< one that stands wide open in the second room
};

/// Rooms side by side on one floor, all at x, y >= 0. A walk visits them in their order.
struct FloorPlan {
  std::string name;
  std::uint64_t seed = 1;
  std::vector<PlanRoom> rooms;
  std::vector<PlanDoor> doors;
};

/// "flat": four rooms and the corridor that joins them, 9.4 x 9.5 m. "loop": eight rooms in a ring,
/// 11.8 x 10.6 m, each with doors to the next and the one before. "hall": one room of 12 x 8.4 m
/// and 3.6 m high, and the lobby before it. "building": office_building of a hundred rooms. Throws
/// Error for another name.
FloorPlan floor_plan(const std::string& name, std::uint64_t seed = 1);
std::vector<std::string> floor_plan_names();

/// Builds and furnishes room by room; every object knows its room, every door has a frame. The same
/// plan gives the same scene. Of several ways to furnish a room, one is taken that leaves a way
/// between all its doors. Throws what build_room throws, and Error for a door that joins no two
/// walls or a room in which no way is left.
SynthRoom build_plan(const FloorPlan& plan,
                     const std::filesystem::path& furniture_folder = default_furniture_folder(),
                     const LayoutConfig& config = {});

}  // namespace ovimap
