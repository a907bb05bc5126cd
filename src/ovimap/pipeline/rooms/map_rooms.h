// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "ovimap/pipeline/approach/standing_space.h"
#include "ovimap/pipeline/rooms/room_plan.h"

namespace ovimap {

/// The room that each object is in, 0 for none: the one that most of its surface is in or nearest
/// to, where that is more than half of it. Walls of several rooms are in none.
std::vector<int> rooms_of_objects(const RoomPlan& plan, const StandingSpace& space,
                                  std::span<const InstanceId> objects);

}  // namespace ovimap
