// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ovimap/synth/buildings/floor_plan.h"

namespace ovimap {

/// A flat of apartments-v1.
struct Flat {
  FloorPlan plan;
  Split split = Split::kTuned;
};

std::vector<Flat> flats();

}  // namespace ovimap
