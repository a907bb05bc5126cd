// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/rooms/map_rooms.h"

#include <map>

namespace ovimap {

namespace {

int room_of(const RoomPlan& plan, const std::vector<SurfaceSample>& samples) {
  std::map<int, std::size_t> votes;
  for (const SurfaceSample& sample : samples)
    // A step off the surface: what hangs on a wall is on the side that it faces.
    ++votes[plan.room_at((sample.point + plan.cell_m * sample.normal).head<2>())];
  for (const auto& [room, count] : votes)
    if (2 * count > samples.size()) return room;
  return 0;
}

}  // namespace

std::vector<int> rooms_of_objects(const RoomPlan& plan, const StandingSpace& space,
                                  std::span<const InstanceId> objects) {
  std::vector<int> rooms;
  for (const InstanceId id : objects) {
    const auto surface = space.surfaces.find(id);
    rooms.push_back(surface == space.surfaces.end() ? 0 : room_of(plan, surface->second));
  }
  return rooms;
}

}  // namespace ovimap
