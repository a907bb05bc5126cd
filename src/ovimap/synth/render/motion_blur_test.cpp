// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/render/motion_blur.h"

#include <vector>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

const PinholeCamera kCamera{40, 30, 30, 30, 19.5f, 14.5f};

Image<Eigen::Vector3f> step_at(int column) {
  Image<Eigen::Vector3f> picture(40, 30, Eigen::Vector3f::Zero());
  for (int y = 0; y < 30; ++y)
    for (int x = column; x < 40; ++x) picture.at(x, y).setOnes();
  return picture;
}

/// Moved to the right by so many pixels of a wall 2 m away.
Pose moved(double px) {
  Pose pose = Pose::Identity();
  pose.translation().x() = px * 2 / 30;
  return pose;
}

TEST(MotionBlur, WithoutMotionThePictureStays) {
  const auto picture = step_at(20);
  const DepthImage wall(40, 30, 2);
  EXPECT_EQ(blurred(picture, wall, kCamera, moved(1), {}), picture);
  const std::vector<Pose> still(5, moved(1));
  const auto same = blurred(picture, wall, kCamera, moved(1), still);
  for (std::size_t i = 0; i < same.size(); ++i)
    EXPECT_LT((same[i] - picture[i]).norm(), 1e-4f) << i;
}

TEST(MotionBlur, AnEdgeBecomesARampAsLongAsTheWay) {
  // Poses 1.5, 0.5, -0.5 and -1.5 pixels aside: the edge between columns 19 and 20 is smeared over
  // four columns, two on either side.
  const std::vector<Pose> poses = {moved(1.5), moved(0.5), moved(-0.5), moved(-1.5)};
  const auto picture = blurred(step_at(20), DepthImage(40, 30, 2), kCamera, moved(0), poses);
  EXPECT_NEAR(picture.at(16, 10).x(), 0, 1e-4f);
  EXPECT_NEAR(picture.at(23, 10).x(), 1, 1e-4f);
  for (int x = 17; x < 22; ++x) EXPECT_LT(picture.at(x, 10).x(), picture.at(x + 1, 10).x()) << x;
  EXPECT_NEAR(picture.at(19, 10).x() + picture.at(20, 10).x(), 1, 1e-4f);
}

TEST(MotionBlur, FarThingsSmearLess) {
  const std::vector<Pose> poses = {moved(3), moved(-3)};
  const auto near = blurred(step_at(20), DepthImage(40, 30, 2), kCamera, moved(0), poses);
  const auto far = blurred(step_at(20), DepthImage(40, 30, 20), kCamera, moved(0), poses);
  EXPECT_NEAR(near.at(21, 10).x(), 0.5f, 1e-4f);
  EXPECT_NEAR(far.at(21, 10).x(), 1, 1e-4f);
}

}  // namespace
}  // namespace ovimap
