// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <vector>

#include "ovimap/map/fusion/free_space.h"
#include "ovimap/pipeline/motion/moving_pixels.h"

namespace ovimap {

/// Cells in which a frame shows surface that does not move.
struct StandingCells {
  std::vector<BlockIndex> cells;  ///< each once
  std::vector<BlockIndex> known;  ///< of those, where the map had surface before anybody counted
};

/// By one pixel in 16. Without cells that were looked through so often that surface in them moves.
StandingCells standing_cells(const VoxelMap& map, const SeenFree& space, const Observation& seen,
                             const IdImage& moving, const MotionConfig& config);

/// Cells near what moves (MotionConfig::beside_m) in which surface was seen for the first time so
/// short a time ago that it may have moved as well, before anybody knew.
std::vector<BlockIndex> fresh_cells(const SeenFree& space, const std::vector<MovingPatch>& patches,
                                    float cell_m, const MotionConfig& config);

/// free_depth for such surface: less far around are looked at, and where something moves, what lies
/// where it is now goes as well.
Image<float> hasty_free_depth(const VoxelMapConfig& map, const Observation& seen,
                              const IdImage& moving, const FreeSpaceConfig& free_space,
                              const MotionConfig& config);

}  // namespace ovimap
