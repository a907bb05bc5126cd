// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/synth/buildings/floor_plan.h"

namespace ovimap {

/// A storey of offices, libraries, canteens, stores and lounges side by side, `across` x `deep`
/// rooms of 50 square metres with some two hundred things each. A walk goes through one row after
/// another and comes back through the first rooms of all rows. Throws Error for no rooms.
FloorPlan office_building(int across, int deep);

}  // namespace ovimap
