// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "ovimap/geometry/pose.h"
#include "ovimap/synth/rooms/room.h"

namespace ovimap {

class ConfigFields;

/// What happens between two visits to a room.
struct VisitsConfig {
  int moved = 3, removed = 1, added = 1;  ///< things, as far as the room has such
  float least_height_m = 0.06f;           ///< lower things, as papers and rugs, stay where they are
  float least_side_m = 0.06f;             ///< likewise, of the longer side of their footprint
  float largest_footprint_m2 = 1;         ///< larger pieces stay where they are
  float tallest_m = 1.5f;                 ///< taller ones likewise, as doors and cupboards
  float least_way_m = 0.3f;               ///< a thing that moves goes at least so far
  int doors = 1;                          ///< leaves that are turned, of doors between rooms
  float least_open_rad = 0.9f;            ///< they never shut: one can still walk through
  float most_open_rad = 1.65f;
  float least_turn_rad = 0.45f;  ///< a leaf that is turned turns at least so far
};
void list_fields(VisitsConfig& config, ConfigFields& fields);

enum class RoomChangeKind { kMoved, kRemoved, kAdded };

/// What became of one thing since the visit before.
struct RoomChange {
  RoomChangeKind kind = RoomChangeKind::kMoved;
  std::uint16_t object = 0;              ///< RoomObject::id, the same in all visits
  Eigen::AlignedBox3f from, to;          ///< where it was, where it is; empty: nowhere
  Pose new_from_old = Pose::Identity();  ///< of a thing that moved, in the world frame
};

/// A room as one visit finds it. Things that are away keep their place in `room.objects`, without
/// mesh, box and footprint, so that ids mean the same thing in every visit.
struct Visit {
  SynthRoom room;
  std::vector<RoomChange> changes;  ///< since the visit before, by object; none in the first
};

/// The room on several occasions in one world frame: between two, things that stand free are moved,
/// carried off, or brought in, and doors that have hinges are opened wider or pushed to. Those
/// brought in are things of the room that earlier visits lacked. Walls, what hangs on them, lamps
/// and pieces that carry others stay. The same room gives the same
/// visits on every machine; the camera walks and errs differently in each (SynthRoom::seed).
std::vector<Visit> plan_visits(const SynthRoom& room, int visits, const VisitsConfig& config = {});

}  // namespace ovimap
