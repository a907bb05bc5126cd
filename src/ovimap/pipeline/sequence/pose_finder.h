// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/pipeline/mapping/mapper.h"
#include "ovimap/track/graph/loop_closure.h"
#include "ovimap/track/tracker.h"

namespace ovimap {

/// What closing loops while frames came did to a map.
struct LoopCorrections {
  std::size_t times = 0;
  double furthest_m = 0;  ///< largest move of a keyframe
};

/// Finds the poses of a run's frames: follows the camera through the map, and where it comes by a
/// place again and stands elsewhere than it seemed, moves poses and map to what agrees with both.
/// When that happens depends on the frames alone.
class PoseFinder {
 public:
  PoseFinder(Tracker tracker, const LoopConfig& loops)
      : tracker_(std::move(tracker)), config_(loops), graph_(tracker_.config(), loops) {}

  /// Gives the frame its pose; where the camera is lost (TrackedFrame::tracked) it means nothing.
  const TrackedFrame& locate(Frame& frame, Mapper& mapper);

  /// Call after a frame that was located is fused. True when `frames`, all that are in the map, and
  /// the map got other poses (Mapper::fuse_again). Leaves to the end (close_last_loops) what is
  /// little, and all of it where the map keeps no frames.
  bool close_loops(Mapper& mapper, std::vector<FrameLogEntry>& frames,
                   const PinholeCamera& depth_camera);

  Tracker& tracker() { return tracker_; }
  const Tracker& tracker() const { return tracker_; }
  const LoopCorrections& corrections() const { return corrections_; }

  /// Called before the map is fused again: its blocks may not be frozen then where it has a store.
  std::function<void(Mapper&)> before_correction;

 private:
  Tracker tracker_;
  LoopConfig config_;
  LoopGraph graph_;
  std::size_t loops_ = 0;      ///< found since the last correction
  double corrected_at_m_ = 0;  ///< of the camera's way
  LoopCorrections corrections_;
};

}  // namespace ovimap
