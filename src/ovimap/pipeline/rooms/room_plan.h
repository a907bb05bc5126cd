// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "ovimap/image/image.h"
#include "ovimap/pipeline/grids/occupancy_grid.h"

namespace ovimap {

class ConfigFields;

struct RoomConfig {
  float low_m = 1.2f;  ///< above the floor: furniture below it is no wall
  float eye_m = 1.8f;  ///< a doorway is open up to here at least
  float door_m = 1.f;  ///< the widest doorway that parts rooms where no lintel above it was seen
  float narrowing = 0.75f;    ///< a doorway is less than this share of the width on both sides
  float least_room_m2 = 1.f;  ///< smaller ones belong to the room they open to
  float least_wall_m2 =
      0.3f;                 ///< obstacles with less floor that touch no wall are lamps and plants
  float free_share = 0.2f;  ///< of a column's cells that must be seen to be free
};
void list_fields(RoomConfig& config, ConfigFields& fields);

/// A part of the floor within walls and doors.
struct Room {
  int id = 0;  ///< 1, 2, ...: largest first
  float area_m2 = 0;
  Eigen::Vector2f center_m = Eigen::Vector2f::Zero();  ///< where it is widest, grid frame
};

/// Where one goes from a room into another.
struct RoomDoor {
  int first = 0, second = 0;                          ///< rooms, first < second
  Eigen::Vector2f place_m = Eigen::Vector2f::Zero();  ///< its middle, grid frame
  float width_m = 0;
};

/// The rooms of a map. The picture is that of a GridSlice: row 0 at the largest y.
struct RoomPlan {
  std::vector<Room> rooms;
  std::vector<RoomDoor> doors;  ///< ordered by rooms
  Image<std::uint16_t> floor;   ///< id of each cell's room; 0: none
  Image<std::uint16_t>
      nearest;  ///< id of the room nearest to each cell, through walls too; 0: none
  Eigen::Vector2f origin = Eigen::Vector2f::Zero();  ///< lower left corner, grid frame, metres
  float cell_m = 0;

  /// The room that a place (grid frame, metres) is in or nearest to; 0: it is off the picture.
  int room_at(const Eigen::Vector2f& place) const;
};

/// Finds rooms in free space: what is free from breast height up to the ceiling, cut where a lintel
/// closes it above a doorway, and else at doorways, which are narrow (a watershed of the distance
/// to walls; Bormann et al., "Room Segmentation: Survey, Implementation, and Analysis", 2016,
/// compare such methods). No rooms: nothing was seen free at that height.
RoomPlan find_rooms(const OccupancyGrid& grid, const RoomConfig& config = {});

}  // namespace ovimap
