// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ovimap/geometry/pose.h"

namespace ovimap {

/// Where a camera was at a time; a trajectory is such poses, earliest first.
struct TimedPose {
  double time_s = 0;
  Pose world_from_camera = Pose::Identity();
};

/// Of errors: translations in metres, rotations in degrees.
struct ErrorStatistics {
  double rmse = 0, mean = 0, median = 0, max = 0;
};

/// How far a trajectory is off the true one (Sturm et al. 2012, as evo computes it).
struct TrajectoryScores {
  std::size_t truth_poses = 0, matched = 0;
  ErrorStatistics ate_m;             ///< of positions after the best rigid alignment
  ErrorStatistics step_m, step_deg;  ///< relative pose error from one matched pose to the next
  double path_m = 0;                 ///< length of the true way between matched poses
  double closure_m = 0;              ///< last position from the first, off the truth's
};

/// Matches each pose of the estimate with the nearest in time of the truth, at most `max_gap_s`
/// away, each used once; aligns by the least-squares rotation and translation (Umeyama 1991, no
/// scale) and compares. Throws Error when fewer than three poses match.
TrajectoryScores score_trajectory(const std::vector<TimedPose>& truth,
                                  const std::vector<TimedPose>& estimate, double max_gap_s);

}  // namespace ovimap
