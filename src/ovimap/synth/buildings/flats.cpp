// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/buildings/flats.h"

#include "ovimap/synth/buildings/flat_rooms.h"

namespace ovimap {
namespace {

constexpr float kW = kPlanWall_m;

struct Site {
  const char* kind;
  float x, y, width, depth;
};

/// `leaves`: a door's leaf stands open in its second room; wide openings have none.
Flat flat(const char* name, Split split, const RoomLight& light, const std::vector<Site>& sites,
          const std::vector<PlanDoor>& doors) {
  constexpr float kWidest_m = 1.f;
  Flat made;
  made.split = split;
  made.plan.name = name;
  made.plan.doors = doors;
  for (PlanDoor& door : made.plan.doors) door.has_leaf = door.width_m < kWidest_m;
  for (const Site& site : sites) {
    RoomSpec spec = flat_room(site.kind, split, {site.width, site.depth});
    spec.light = light;
    made.plan.rooms.push_back({std::move(spec), {site.x, site.y}});
  }
  return made;
}

/// Rooms on both sides of a long hall, evening light from warm lamps.
Flat courtyard() {
  constexpr float kHall = 4.4f + kW, kNorth = kHall + 1.6f + kW;
  return flat("courtyard", Split::kTuned, {1.15f, 0.5f, 0.8f, {1.06f, 1.f, 0.9f}},
              {{"hall", 0, kHall, 9.f, 1.6f},
               {"living-room", 0, 0, 5.2f, 4.4f},
               {"kitchen", 5.2f + kW, 0, 3.8f - kW, 4.4f},
               {"study", 4.4f + kW, kNorth, 4.6f - kW, 3.5f},
               {"bedroom", 0, kNorth, 4.4f, 3.5f}},
              {{0, 1, 2.6f}, {1, 2, 2.2f, 1.3f}, {0, 2, 7.2f}, {0, 3, 6.8f}, {0, 4, 2.2f}});
}

/// A hall from front to back, three rooms east, two west; bright, cool daylight.
Flat harbour() {
  constexpr float kMiddle = 4.f + kW, kEast = kMiddle + 1.5f + kW;
  return flat("harbour", Split::kUnseen, {0.55f, 1.5f, 1.1f, {0.97f, 1.f, 1.05f}},
              {{"hall", kMiddle, 0, 1.5f, 10.2f},
               {"living-room", 0, 0, 4.f, 5.6f},
               {"bedroom", 0, 5.6f + kW, 4.f, 4.6f - kW},
               {"study", kEast, 6.9f + 2 * kW, 3.6f, 3.3f - 2 * kW},
               {"child-room", kEast, 3.7f + kW, 3.6f, 3.2f},
               {"kitchen", kEast, 0, 3.6f, 3.7f}},
              {{0, 1, 2.8f, 1.2f}, {0, 2, 7.6f}, {0, 3, 8.6f}, {0, 4, 5.3f}, {0, 5, 1.6f}});
}

/// Four rooms in a ring without a hall; few lamps, dim.
Flat meadow() {
  constexpr float kEast = 5.6f + kW, kNorth = 4.3f + kW;
  return flat("meadow", Split::kUnseen, {0.8f, 0.8f, 0.55f, {1.f, 0.98f, 0.95f}},
              {{"living-room", 0, 0, 5.6f, 4.3f},
               {"kitchen", kEast, 0, 4.4f, 4.3f},
               {"study", kEast, kNorth, 4.4f, 3.7f},
               {"bedroom", 0, kNorth, 5.6f, 3.7f}},
              {{0, 1, 2.1f, 1.4f}, {1, 2, 8.f}, {2, 3, 6.3f}, {3, 0, 2.4f}});
}

}  // namespace

std::vector<Flat> flats() {
  return {courtyard(), harbour(), meadow()};
}

}  // namespace ovimap
