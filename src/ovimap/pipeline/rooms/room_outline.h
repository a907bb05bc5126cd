// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ovimap/pipeline/rooms/room_plan.h"

namespace ovimap {

/// Closed, without the first corner again; grid frame, metres.
using Polygon = std::vector<Eigen::Vector2f>;

/// The borders of a room's floor: around it counter-clockwise, around what stands in it clockwise,
/// within a cell of the cells' own sides (Douglas and Peucker 1973). The largest first; none for a
/// room that the plan does not have.
std::vector<Polygon> room_outline(const RoomPlan& plan, int room);

}  // namespace ovimap
