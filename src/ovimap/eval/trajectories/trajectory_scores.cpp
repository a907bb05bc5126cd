// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/trajectories/trajectory_scores.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

struct PosePair {
  Pose truth, estimate;
};

ErrorStatistics statistics_of(std::vector<double> errors) {
  ErrorStatistics result;
  if (errors.empty()) return result;
  double sum = 0, squares = 0;
  for (const double error : errors) sum += error, squares += error * error;
  std::sort(errors.begin(), errors.end());
  const auto count = static_cast<double>(errors.size());
  const std::size_t middle = errors.size() / 2;
  result.rmse = std::sqrt(squares / count);
  result.mean = sum / count;
  result.median =
      errors.size() % 2 == 1 ? errors[middle] : (errors[middle - 1] + errors[middle]) / 2;
  result.max = errors.back();
  return result;
}

std::vector<PosePair> match(const std::vector<TimedPose>& truth,
                            const std::vector<TimedPose>& estimate, double max_gap_s) {
  std::vector<PosePair> pairs;
  std::size_t at = 0, unused = 0;
  for (const TimedPose& pose : estimate) {
    const auto gap = [&](std::size_t i) { return std::fabs(truth[i].time_s - pose.time_s); };
    at = std::max(at, unused);
    while (at + 1 < truth.size() && gap(at + 1) <= gap(at)) ++at;
    if (at >= truth.size() || gap(at) > max_gap_s) continue;
    pairs.push_back({truth[at].world_from_camera, pose.world_from_camera});
    unused = at + 1;
  }
  return pairs;
}

/// The rotation and translation that lay the estimate's positions over the true ones.
Pose aligning(const std::vector<PosePair>& pairs) {
  Eigen::Matrix3Xd from(3, pairs.size()), to(3, pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    from.col(static_cast<Eigen::Index>(i)) = pairs[i].estimate.translation();
    to.col(static_cast<Eigen::Index>(i)) = pairs[i].truth.translation();
  }
  return Pose(Eigen::umeyama(from, to, false));
}

}  // namespace

TrajectoryScores score_trajectory(const std::vector<TimedPose>& truth,
                                  const std::vector<TimedPose>& estimate, double max_gap_s) {
  const std::vector<PosePair> pairs = match(truth, estimate, max_gap_s);
  if (pairs.size() < 3)
    throw Error(concat(
        "only ", pairs.size(), " of ", estimate.size(), " poses have a true one within ", max_gap_s,
        " s; give trajectories of one recording and one clock, or a wider --max-gap"));
  TrajectoryScores scores;
  scores.truth_poses = truth.size();
  scores.matched = pairs.size();
  const Pose truth_from_estimate = aligning(pairs);
  std::vector<double> off_m, step_m, step_deg;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    off_m.push_back(
        (truth_from_estimate * pairs[i].estimate.translation() - pairs[i].truth.translation())
            .norm());
    if (i == 0) continue;
    const Pose true_step = pairs[i - 1].truth.inverse() * pairs[i].truth;
    const Pose off = true_step.inverse() * (pairs[i - 1].estimate.inverse() * pairs[i].estimate);
    step_m.push_back(off.translation().norm());
    step_deg.push_back(Eigen::AngleAxisd(off.linear()).angle() * 180 / std::numbers::pi);
    scores.path_m += true_step.translation().norm();
  }
  const Pose closure = (pairs.front().truth.inverse() * pairs.back().truth).inverse() *
                       (pairs.front().estimate.inverse() * pairs.back().estimate);
  scores.closure_m = closure.translation().norm();
  scores.ate_m = statistics_of(std::move(off_m));
  scores.step_m = statistics_of(std::move(step_m));
  scores.step_deg = statistics_of(std::move(step_deg));
  return scores;
}

}  // namespace ovimap
