// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/graph/moved_poses.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

Pose at(double x, double y) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(x, y, 0);
  return pose;
}

TEST(Follow, MovesPosesBetweenThoseThatMoved) {
  std::vector<Keyframe> keyframes(2);
  keyframes[1].index = 10;
  keyframes[1].world_from_camera = at(1, 0);
  const std::vector<Pose> moved =
      follow({at(0.5, 0), at(0.5, 0)}, {5, 20},
             moved_keyframes(keyframes, {Pose::Identity(), at(1, 0.2)}));
  EXPECT_NEAR(moved[0].translation().y(), 0.1, 1e-9);
  EXPECT_NEAR(moved[1].translation().y(), 0.2, 1e-9);
}

TEST(Follow, PosesBeforeTheFirstAndBetweenTwoOfOneTime) {
  const std::vector<MovedPose> moves = {{2, at(0, 0), at(1, 0)}, {2, at(0, 0), at(3, 0)}};
  const std::vector<Pose> moved = follow({at(0, 0), at(0, 0)}, {1, 2}, moves);
  EXPECT_NEAR(moved[0].translation().x(), 1, 1e-9);
  EXPECT_NEAR(moved[1].translation().x(), 3, 1e-9);
}

}  // namespace
}  // namespace ovimap
