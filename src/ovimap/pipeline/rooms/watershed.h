// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "ovimap/image/image.h"

namespace ovimap {

struct WatershedConfig {
  float widest_pass = 0;  ///< height of the highest pass that parts two basins
  float share = 1;        ///< ... which must be lower than this share of both peaks
};

/// Parts a height map into the regions of its peaks: 1, 2, ... by falling peak, 0 where the height
/// is 0 (and beyond 65,535 regions). Going down from the peaks, two regions that meet are one
/// unless they meet at a pass as the config says. Ties go by place, so that equal maps give equal
/// regions. Linear but for sorting (union-find, as in Edelsbrunner and Harer, "Computational
/// Topology", 2010, chapter VII).
Image<std::uint16_t> watershed(const Image<float>& height, const WatershedConfig& config);

}  // namespace ovimap
