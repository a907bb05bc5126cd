// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "ovimap/map/fusion/seen_free.h"
#include "ovimap/pipeline/motion/motion_config.h"

namespace ovimap {

/// The pixels in which surface contradicts seen-empty space: frames looked through its cell, and
/// through that behind it by the margin. Not 0: it does. The observation must have sigma_m and
/// plane_slope. The same bits for every number of threads.
Image<std::uint8_t> contradicting_pixels(const VoxelMapConfig& map, const SeenFree& space,
                                         const Observation& observation,
                                         const MotionConfig& config);

}  // namespace ovimap
