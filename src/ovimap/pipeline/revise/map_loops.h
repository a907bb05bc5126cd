// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "ovimap/pipeline/revise/map_correction.h"
#include "ovimap/track/graph/loop_closure.h"

namespace ovimap {

/// The places that a map's kept frames show, in the order in which they were taken.
std::vector<Keyframe> keyframes_of(const MapDocument& map, const KeyframeSpacing& spacing);

struct LoopReport {
  std::size_t keyframes = 0, candidates = 0, closed = 0, dropped = 0;
  double furthest_m = 0;                     ///< largest move of a keyframe
  std::optional<PoseCorrection> correction;  ///< where the map was fused again
};

/// Closes the loops of a map that keeps frames, and fuses it anew (correct_poses) where a pose
/// moved by more than half a voxel. Nothing but the map decides, so it can be done again after a
/// crash.
LoopReport close_map_loops(MapDocument& map, const MapperConfig& mapper, const TrackConfig& track,
                           const LoopConfig& loops,
                           const std::function<void(std::size_t, std::size_t)>& progress = nullptr);

}  // namespace ovimap
