// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ovimap/synth/rooms/room_spec.h"

namespace ovimap {

/// The five rooms of the benchmark, seeds aside: living room, bedroom, kitchen, office, bathroom.
std::vector<RoomSpec> rooms_v1();

/// A camera of 67 degrees across, as depth cameras have.
PinholeCamera synth_camera(int width, int height);

}  // namespace ovimap
