// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "ovimap/pipeline/mapping/mapper.h"
#include "ovimap/track/graph/loop_closure.h"

namespace ovimap {

/// The places that kept frames (by their position in `frames`) show, in the order in which they
/// were taken.
std::vector<Keyframe> keyframes_of(const std::vector<FrameLogEntry>& frames, const KeptFrames& kept,
                                   const PinholeCamera& depth_camera,
                                   const KeyframeSpacing& spacing);

struct LoopReport {
  std::size_t keyframes = 0, candidates = 0, closed = 0, dropped = 0;
  double furthest_m = 0;   ///< largest move of a keyframe
  double fused_share = 0;  ///< of the map's blocks that were made anew
};

/// Closes the loops of a run after its last frame, and moves frames and map to what agrees with
/// them (Mapper::fuse_again) where a keyframe moved by more than half a voxel. Nothing but the map
/// and what it keeps decides, so it can be done again after a crash. Does nothing where no frame is
/// kept.
LoopReport close_last_loops(
    Mapper& mapper, std::vector<FrameLogEntry>& frames, const PinholeCamera& depth_camera,
    const TrackConfig& track, const LoopConfig& loops,
    const std::function<void(std::size_t, std::size_t)>& progress = nullptr);

}  // namespace ovimap
