// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ovimap/pipeline/approach/approach.h"
#include "ovimap/pipeline/approach/gaps.h"

namespace ovimap {

/// {"poses": [{"x", "y", "yaw", "tilt", "seen", "distance_m", "way_m", "way", "position",
/// "direction", "way_in_world"}], "reason"}: metres and radians. x, y, yaw and way ([x, y] a
/// corner) are in the frame of the exported grid (z up); position, way_in_world (points on the
/// floor) and direction (of the gaze, unit length) in the world frame.
nlohmann::json approach_json(const Approach& approach, const OccupancyGrid& grid);

/// {"gaps": [{"kind": "unseen" or "thin", "middle": [x, y, z], "box": {"min", "max"}, "area_m2"}]},
/// world, metres.
nlohmann::json gaps_json(const std::vector<Gap>& gaps);

}  // namespace ovimap
