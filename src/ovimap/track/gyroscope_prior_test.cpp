// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/gyroscope_prior.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

Eigen::Quaterniond about_y(double rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(rad, Eigen::Vector3d::UnitY()));
}

Frame frame_at(const std::optional<Eigen::Quaterniond>& orientation) {
  Frame frame;
  frame.orientation = orientation;
  return frame;
}

TEST(GyroscopePrior, TellsTheTurnSinceTheLastTrackedFrame) {
  GyroscopePrior gyroscope;
  EXPECT_FALSE(gyroscope.turn_to(frame_at(about_y(0.3))));
  gyroscope.tracked(frame_at(about_y(0.3)), std::nullopt);
  EXPECT_FALSE(gyroscope.turn_to(frame_at(std::nullopt)));
  const auto turn = gyroscope.turn_to(frame_at(about_y(0.5)));
  ASSERT_TRUE(turn);
  EXPECT_LT(turn->angularDistance(about_y(0.2)), 1e-9);
  gyroscope.tracked(frame_at(std::nullopt), std::nullopt);
  EXPECT_FALSE(gyroscope.turn_to(frame_at(about_y(0.5))));
}

/// The images turn by 0.03 a frame; the gyroscope as `rad_of(i)` says.
template <class Rad>
GyroscopePrior after(int frames, const Rad& rad_of) {
  GyroscopePrior gyroscope;
  for (int i = 0; i < frames; ++i)
    gyroscope.tracked(frame_at(about_y(rad_of(i))), about_y(0.03).matrix());
  return gyroscope;
}

TEST(GyroscopePrior, IsNotBelievedWhenImagesContradictItAgainAndAgain) {
  EXPECT_FALSE(after(200, [](int i) { return 0.03 * i; }).is_contradicted());
  EXPECT_FALSE(after(200, [](int i) { return 0.033 * i; }).is_contradicted());  // a bias
  EXPECT_TRUE(after(30, [](int i) { return -0.03 * i; }).is_contradicted());
  EXPECT_TRUE(after(30, [](int i) { return 0.03 * 57.3 * i; }).is_contradicted());  // degrees
  const GyroscopePrior unknown = after(15, [](int i) { return -0.03 * i; });  // too few to say
  EXPECT_FALSE(unknown.is_contradicted() || unknown.is_confirmed());
  EXPECT_TRUE(after(30, [](int i) { return 0.03 * i; }).is_confirmed());
  const GyroscopePrior wrong = after(30, [](int i) { return -0.03 * i; });
  EXPECT_FALSE(wrong.turn_to(frame_at(about_y(1))));
}

TEST(GyroscopePrior, OneJumpOfItsWorldIsForgiven) {
  EXPECT_FALSE(after(60, [](int i) { return 0.03 * i + (i > 20 ? 2.0 : 0.0); }).is_contradicted());
}

TEST(GyroscopePrior, StillCamerasSayNothingOfIt) {
  GyroscopePrior gyroscope;
  for (int i = 0; i < 100; ++i)
    gyroscope.tracked(frame_at(about_y(i % 2 == 0 ? 0.004 : 0.0)),
                      Eigen::Matrix3d(about_y(-0.003).matrix()));
  EXPECT_EQ(gyroscope.compared(), 0);
}

}  // namespace
}  // namespace ovimap
