// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/rooms/places.h"

#include <algorithm>

namespace ovimap {

PlaceGraph find_places(const GridSlice& walking, const RoomPlan& plan, float least_radius_m) {
  const int width = walking.occupancy.width(), height = walking.occupancy.height();
  std::vector<Place> free;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float radius = walking.distance_m.at(x, y);
      if (walking.occupancy.at(x, y) != kFreeLevel || radius < least_radius_m) continue;
      Place place;
      place.middle_m = middle_of_cell(walking.origin, walking.cell_m, height, x, y);
      place.radius_m = radius;
      place.room = plan.room_at(place.middle_m);
      free.push_back(place);
    }
  std::stable_sort(free.begin(), free.end(),
                   [](const Place& a, const Place& b) { return a.radius_m > b.radius_m; });
  PlaceGraph graph;
  for (const Place& place : free) {
    const bool covered =
        std::any_of(graph.places.begin(), graph.places.end(), [&](const Place& other) {
          return (other.middle_m - place.middle_m).norm() < other.radius_m;
        });
    if (!covered) graph.places.push_back(place);
  }
  for (std::size_t a = 0; a < graph.places.size(); ++a)
    for (std::size_t b = a + 1; b < graph.places.size(); ++b)
      if ((graph.places[a].middle_m - graph.places[b].middle_m).norm() <
          graph.places[a].radius_m + graph.places[b].radius_m)
        graph.links.emplace_back(a, b);
  return graph;
}

}  // namespace ovimap
