// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/trajectories/trajectory_scores.h"

#include <gtest/gtest.h>

#include "ovimap/base/error.h"

namespace ovimap {
namespace {

std::vector<TimedPose> curve() {
  std::vector<TimedPose> poses;
  for (int i = 0; i < 20; ++i) {
    const double t = 0.1 * i;
    TimedPose pose{t, Pose::Identity()};
    pose.world_from_camera.translation() = Eigen::Vector3d(t, std::sin(t), 0.5 * t * t);
    pose.world_from_camera.linear() = Eigen::AngleAxisd(t, Eigen::Vector3d::UnitZ()).matrix();
    poses.push_back(pose);
  }
  return poses;
}

TEST(TrajectoryScores, AnotherWorldIsNoError) {
  Pose other(Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized()));
  other.translation() = Eigen::Vector3d(3, 2, 1);
  std::vector<TimedPose> estimate = curve();
  for (TimedPose& pose : estimate) pose.world_from_camera = other * pose.world_from_camera;
  const TrajectoryScores scores = score_trajectory(curve(), estimate, 0.01);
  EXPECT_EQ(scores.matched, 20u);
  EXPECT_LT(scores.ate_m.max, 1e-9);
  EXPECT_LT(scores.step_m.max, 1e-9);
  EXPECT_LT(scores.closure_m, 1e-9);
}

TEST(TrajectoryScores, TellStepsFromPlaces) {
  std::vector<TimedPose> estimate = curve();
  for (std::size_t i = 10; i < 20; ++i) estimate[i].world_from_camera.translation().z() += 0.1;
  const TrajectoryScores scores = score_trajectory(curve(), estimate, 0.01);
  EXPECT_NEAR(scores.step_m.max, 0.1, 1e-9);
  EXPECT_NEAR(scores.step_m.median, 0, 1e-9);
  EXPECT_NEAR(scores.step_m.rmse, 0.1 / std::sqrt(19.), 1e-9);
  EXPECT_GT(scores.ate_m.rmse, 0.005);
  EXPECT_LT(scores.ate_m.rmse, 0.05);
  EXPECT_NEAR(scores.closure_m, 0.1, 1e-9);
}

TEST(TrajectoryScores, MatchesByTimeEachTruthOnce) {
  std::vector<TimedPose> estimate = {curve()[3], curve()[3], curve()[5], curve()[9]};
  estimate[1].time_s += 0.004;
  estimate[2].time_s -= 0.004;
  estimate[3].time_s += 0.02;
  EXPECT_THROW(score_trajectory(curve(), estimate, 0.01), Error);
  estimate[3].time_s -= 0.015;
  EXPECT_EQ(score_trajectory(curve(), estimate, 0.01).matched, 3u);
}

}  // namespace
}  // namespace ovimap
