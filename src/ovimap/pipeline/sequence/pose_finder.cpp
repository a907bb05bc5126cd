// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/pose_finder.h"

#include "ovimap/pipeline/sequence/moved_frames.h"

namespace ovimap {

const TrackedFrame& PoseFinder::locate(Frame& frame, Mapper& mapper) {
  auto t = mapper.timers().measure("track");
  const TrackedFrame& tracked = tracker_.track(frame, mapper.map());
  frame.world_from_camera = tracked.world_from_camera;
  frame.posed = true;
  return tracked;
}

bool PoseFinder::close_loops(Mapper& mapper, std::vector<FrameLogEntry>& frames,
                             const PinholeCamera& depth_camera) {
  if (!config_.online || mapper.kept_frames().empty()) return false;
  const std::vector<Keyframe>& keyframes = tracker_.keyframes();
  const LoopClosure closure = [&] {
    auto t = mapper.timers().measure("find_loops");
    const std::size_t found = graph_.take(keyframes);
    loops_ += found;
    const bool due = found > 0 && loops_ >= static_cast<std::size_t>(config_.agreeing) &&
                     (corrections_.times == 0 ||
                      graph_.path_m() >= corrected_at_m_ + static_cast<double>(config_.pause_m));
    return due ? graph_.solve(keyframes) : LoopClosure();
  }();
  const double least_m =
      static_cast<double>(config_.least_voxels * mapper.config().map.voxel_size_m);
  if (closure.closed < static_cast<std::size_t>(config_.agreeing) || closure.furthest_m < least_m)
    return false;
  if (before_correction) before_correction(mapper);
  move_frames(moved_keyframes(keyframes, closure.poses), false, mapper, frames, depth_camera);
  tracker_.correct(closure.poses);
  loops_ = 0;
  corrected_at_m_ = graph_.path_m();
  ++corrections_.times;
  corrections_.furthest_m = std::max(corrections_.furthest_m, closure.furthest_m);
  return true;
}

}  // namespace ovimap
