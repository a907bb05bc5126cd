// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/check/depth_agreement.h"

#include <gtest/gtest.h>

#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap {
namespace {

Frame room_frame(int index) {
  const fixture::Sequence sequence;
  Frame frame;
  frame.depth = sequence.depth(index);
  frame.depth_camera = sequence.depth_camera;
  frame.world_from_camera = fixture::room_pose(index);
  return frame;
}

TEST(ThinFrame, KeepsEveryNthPixelOnItsRay) {
  const Frame frame = room_frame(0);  // 80 x 60
  const ThinFrame thin = thin_frame(frame, 30);
  ASSERT_EQ(thin.depth.width(), 27);
  ASSERT_EQ(thin.depth.height(), 20);
  EXPECT_EQ(thin.depth.at(5, 7), frame.depth.at(15, 21));
  EXPECT_TRUE(
      thin.camera.unproject(5, 7, 2.f).isApprox(frame.depth_camera.unproject(15, 21, 2.f), 1e-6f));
  EXPECT_EQ(thin_frame(frame, 80).depth, frame.depth);
}

TEST(DepthAgreement, TruePosesAgreeAndAllMistakesDoNot) {
  const std::vector<std::pair<ThinFrame, ThinFrame>> pairs = {
      {thin_frame(room_frame(0), 80), thin_frame(room_frame(10), 80)}};
  const auto readings = usual_reinterpretations();
  const Agreement truth = measure_agreement(pairs, readings.front(), 0.02);
  EXPECT_GT(truth.share(), 0.95);
  EXPECT_GT(truth.overlap(), 0.5);
  EXPECT_EQ(truth.points, 2 * 80 * 60);
  for (std::size_t i = 1; i < readings.size(); ++i) {
    // A focal length that is a little off disagrees only a little.
    const double limit = readings[i].focal_factor == 1 ? 0.8 : truth.share();
    EXPECT_LT(measure_agreement(pairs, readings[i], 0.02).share(), limit) << i;
  }
}

TEST(DepthAgreement, HandComputedWall) {
  // A wall 2 m ahead, seen again from 0.5 m nearer but recorded as if it were still 2 m away.
  Frame frame = room_frame(0);
  frame.depth.fill(2.f);
  frame.world_from_camera.setIdentity();
  Frame nearer = frame;
  nearer.world_from_camera.translation().z() = 0.5;
  const auto agreement = [&](double tolerance) {
    return measure_agreement({{thin_frame(frame, 80), thin_frame(nearer, 80)}}, {}, tolerance)
        .share();
  };
  EXPECT_EQ(agreement(0.24), 0);  // 1.5 or 2.5 m instead of 2 m: a quarter off
  EXPECT_EQ(agreement(0.26), 1);
}

TEST(Reinterpretation, UndoesWhatItNames) {
  const Pose truth = fixture::room_pose(4);
  Reinterpretation inverted;
  inverted.direction = PoseConvention::Direction::kCameraFromWorld;
  EXPECT_TRUE(inverted.pose(truth.inverse()).isApprox(truth, 1e-12));
  EXPECT_TRUE(Reinterpretation{}.pose(truth).isApprox(truth, 1e-12));
}

}  // namespace
}  // namespace ovimap
