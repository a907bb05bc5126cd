// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/synth/rooms/room_spec.h"

namespace ovimap {

/// A room of a floor plan, with less furniture than a room by itself: one walks through it. `kind`:
/// one of rooms_v1_names, "hall" or "dining-room".
RoomSpec plan_room(const std::string& kind, const Eigen::Vector3f& size_m);

}  // namespace ovimap
