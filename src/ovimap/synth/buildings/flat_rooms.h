// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "ovimap/synth/rooms/room_spec.h"

namespace ovimap {

/// A room of a flat that people live in, furnished by rule: "living-room", "kitchen", "bedroom",
/// "study", "child-room", "hall". Throws Error for another kind.
RoomSpec flat_room(const std::string& kind, Split split, const Eigen::Vector2f& floor_m);

}  // namespace ovimap
