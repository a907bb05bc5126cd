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
  float step_sigma_m = 0.008f, step_sigma_rad = 0.006f;  ///< of the motion between two keyframes
  float loop_sigma_m = 0.01f, loop_sigma_rad = 0.006f;   ///< of a verified place
  float most_sigmas = 8.f;  ///< loops that the poses of all contradict more are dropped
};
void list_fields(LoopConfig& config, ConfigFields& fields);

/// What closing loops gave.
struct LoopClosure {
  std::vector<Pose> poses;  ///< of the keyframes, corrected
  std::size_t candidates = 0, closed = 0, dropped = 0;
  double furthest_m = 0;  ///< largest move of a keyframe
};

/// Finds places that were seen again (their codes, or poses that the drift makes possible), aligns
/// the frames of each pair, believes what a lost frame would have to reach, and solves for the
/// poses that agree with all of it. Keyframes in the order in which they were taken.
LoopClosure close_loops(const std::vector<Keyframe>& keyframes, const TrackConfig& track,
                        const LoopConfig& config);

/// Moves poses as the keyframes around them moved. `order[i]`: the source index of poses[i].
std::vector<Pose> follow_keyframes(const std::vector<Pose>& poses,
                                   const std::vector<std::int64_t>& order,
                                   const std::vector<Keyframe>& keyframes,
                                   const std::vector<Pose>& corrected);

}  // namespace ovimap
