// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/picture_motion.h"

#include <numbers>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

constexpr PinholeCamera kCamera{160, 120, 150.f, 150.f, 79.5f, 59.5f};

/// A wall in front of the camera.
Frame wall(float distance_m, const Pose& world_from_camera = Pose::Identity()) {
  Frame frame;
  frame.depth_camera = frame.color_camera = kCamera;
  frame.depth = DepthImage(kCamera.width, kCamera.height, distance_m);
  frame.world_from_camera = world_from_camera;
  return frame;
}

Pose shifted(double x_m) {
  Pose pose = Pose::Identity();
  pose.translation().x() = x_m;
  return pose;
}

TEST(PictureMotion, IsWhatASidewaysStepMovesAtItsDistance) {
  for (const float distance : {0.5f, 1.f, 4.f})
    EXPECT_NEAR(picture_motion(wall(distance), shifted(0.1 * distance)), 0.1f * 150 / 160, 1e-4f);
  EXPECT_EQ(picture_motion(wall(1.f), Pose::Identity()), 0.f);
  EXPECT_EQ(picture_motion(wall(0.f), shifted(1)), 0.f) << "nothing is seen that could move";
}

TEST(PictureMotion, AllOfItWhereTheOtherPoseLooksElsewhere) {
  Pose back = Pose::Identity();
  back.linear() = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitY()).matrix();
  EXPECT_EQ(picture_motion(wall(1.f), back), 1.f);
  EXPECT_EQ(picture_motion(wall(1.f), shifted(3)), 1.f);
}

/// The frames of a walk along a wall, by metres between them, that are wanted.
std::vector<int> wanted(MaskMotion motion, const std::vector<double>& steps_m) {
  std::vector<int> result;
  double x = 0;
  for (std::size_t i = 0; i < steps_m.size(); ++i) {
    const Frame frame = wall(1.f, shifted(x += steps_m[i]));
    const bool wants = motion.wants(frame);
    motion.add(frame.world_from_camera);
    if (!wants) continue;
    motion.masked();
    result.push_back(static_cast<int>(i));
  }
  return result;
}

TEST(MaskMotion, TakesEveryFrameOfASparseWalkAndFewOfADenseOne) {
  const std::vector<double> sparse(5, 0.2), dense(31, 0.0101 * 160 / 150);
  EXPECT_EQ(wanted(MaskMotion(0.1f), sparse), (std::vector{0, 1, 2, 3, 4}));
  EXPECT_EQ(wanted(MaskMotion(0.1f), dense), (std::vector{0, 10, 20, 30}));
  EXPECT_EQ(wanted(MaskMotion(0.f), std::vector<double>(4, 0.0)), (std::vector{0, 1, 2, 3}));
}

TEST(MaskMotion, ACameraThatStandsStillIsNotAskedAbout) {
  EXPECT_EQ(wanted(MaskMotion(0.1f), std::vector<double>(200, 0.0)), std::vector{0});
}

TEST(MaskMotion, WaitsALittleForASlowFrame) {
  // Fast frames of 3 cm, slow ones of 1 cm: 12 cm are reached in a fast one.
  std::vector<double> steps{0, 0.01, 0.02, 0.02, 0.02, 0.02, 0.03, 0.01, 0.02};
  EXPECT_EQ(wanted(MaskMotion(0.1f), steps), (std::vector{0, 7}));
  steps[7] = 0.03;  // none comes
  steps[8] = 0.03;
  EXPECT_EQ(wanted(MaskMotion(0.1f), steps), (std::vector{0, 8}));
}

TEST(MaskMotion, AFrameThatWentWithoutIsMadeUpForByTheNext) {
  MaskMotion motion(0.1f);
  motion.add(Pose::Identity());
  motion.masked();
  ASSERT_FALSE(motion.wants(wall(1.f)));
  motion.went_without();
  EXPECT_TRUE(motion.wants(wall(1.f)));
}

TEST(MaskMotion, FollowsPosesThatMove) {
  MaskMotion motion(0.1f);
  for (int i = 0; i < 100; ++i) {
    motion.add(shifted(0));
    if (i == 20) motion.masked();
  }
  std::vector<Pose> moved(100, shifted(1));
  EXPECT_FALSE(motion.wants(wall(1.f)));
  motion.move(moved);
  EXPECT_TRUE(motion.wants(wall(1.f)));
  moved[20] = shifted(0);  // the one with masks
  motion.move(moved);
  EXPECT_FALSE(motion.wants(wall(1.f)));
}

}  // namespace
}  // namespace ovimap
