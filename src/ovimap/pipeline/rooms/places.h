// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "ovimap/pipeline/rooms/room_plan.h"

namespace ovimap {

/// A free disk of floor.
struct Place {
  Eigen::Vector2f middle_m = Eigen::Vector2f::Zero();  ///< grid frame
  float radius_m = 0;                                  ///< to the nearest obstacle
  int room = 0;                                        ///< 0: none
};

/// Where one can be, and from where to where one can go straight.
struct PlaceGraph {
  std::vector<Place> places;                               ///< widest first
  std::vector<std::pair<std::size_t, std::size_t>> links;  ///< places whose disks overlap
};

/// Covers the free floor with disks, the widest first, each with its middle outside all before it;
/// narrower ones than `least_radius_m` are left out. `walking`: the band that a body takes up.
PlaceGraph find_places(const GridSlice& walking, const RoomPlan& plan, float least_radius_m = 0.2f);

}  // namespace ovimap
