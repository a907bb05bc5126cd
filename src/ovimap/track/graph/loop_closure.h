// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/track/graph/pose_graph.h"
#include "ovimap/track/places/track_config.h"

namespace ovimap {

struct LoopConfig {
  float min_path_m = 4.f;  ///< a loop is a place seen again after the camera went so far
  int candidates = 3;      ///< places that a keyframe is held against
  float min_similarity = 0.6f;
  float near_m = 0.5f;  ///< keyframes estimated so near each other are held against each other
  float drift_per_m = 0.02f;  ///< as well, this much farther for each metre between them
  float way_m = 3.f;  ///< keyframes of so much way to either side of a place show it together
  float step_sigma_m = 0.008f, step_sigma_rad = 0.006f;  ///< of the motion between two keyframes
  float loop_sigma_m = 0.01f, loop_sigma_rad = 0.006f;   ///< of a verified place
  float most_sigmas = 8.f;  ///< loops that the poses of all contradict more are dropped
  // While frames come.
  bool online = true;
  int agreeing = 2;          ///< loops that agree before the map is corrected
  float least_voxels = 2.f;  ///< keyframes that moved less are left to the end
  float pause_m = 2.f;       ///< the camera goes so far before the next correction
};
void list_fields(LoopConfig& config, ConfigFields& fields);

/// What closing loops gave.
struct LoopClosure {
  std::vector<Pose> poses;  ///< of the keyframes, corrected
  std::size_t candidates = 0, closed = 0, dropped = 0;
  double furthest_m = 0;  ///< largest move of a keyframe
};

/// Keyframes as they come, how the camera went from each to the next, and which places it saw
/// again.
class LoopGraph {
 public:
  LoopGraph(const TrackConfig& track, const LoopConfig& config) : track_(track), config_(config) {}

  /// Takes those of `keyframes`, which are in the order in which they were taken, that came since
  /// the last time. Finds places that they show again (their codes, or poses that the drift makes
  /// possible), aligns the frames of each pair and believes what a lost frame would have to reach.
  /// Where no pair does, the frame is held against what the keyframes on the way through the
  /// nearest place show together (place_view): the camera may come by it at another angle. The way
  /// to a new keyframe is that of its pose, and stays that when poses are corrected later. Returns
  /// how many loops are new.
  std::size_t take(const std::vector<Keyframe>& keyframes);

  /// The poses that agree with all of it; the first keyframe stays.
  LoopClosure solve(const std::vector<Keyframe>& keyframes) const;

  double path_m() const { return paths_m_.empty() ? 0 : paths_m_.back(); }

 private:
  std::size_t add_loops(std::size_t at, const std::vector<Keyframe>& keyframes);

  TrackConfig track_;
  LoopConfig config_;
  std::vector<PoseEdge> edges_;
  std::vector<double> paths_m_;  ///< the way up to each keyframe
  std::size_t candidates_ = 0;
};

/// Closes the loops of keyframes that are all there.
LoopClosure close_loops(const std::vector<Keyframe>& keyframes, const TrackConfig& track,
                        const LoopConfig& config);

}  // namespace ovimap
