// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/sensor_doubts.h"

#include <gtest/gtest.h>

#include "ovimap/track/room_camera_fixture.h"

namespace ovimap {
namespace {

/// A camera that turns to and fro while it goes.
class SensorDoubts : public ::testing::Test {
 protected:
  SensorDoubts() { camera_.camera = {320, 240, 280.f, 280.f, 159.5f, 119.5f}; }

  static Pose pose(double at) {
    const double along = at / 3;
    const int step = static_cast<int>(std::floor(along));
    Pose pose = fixture::room_pose(step);
    const double rest = along - step;
    const Pose next = fixture::room_pose(step + 1);
    pose.translation() += rest * (next.translation() - pose.translation());
    pose.linear() =
        Eigen::Quaterniond(pose.linear()).slerp(rest, Eigen::Quaterniond(next.linear())).matrix();
    pose.rotate(Eigen::AngleAxisd(0.05 * std::sin(0.2 * at), Eigen::Vector3d::UnitY()));
    return pose;
  }
  /// `change` makes what is wrong with a frame.
  template <class Change>
  void walk(int frames, const Change& change) {
    for (int i = 0; i < frames; ++i) {
      Frame frame = camera_.take(pose(i), i);
      frame.posed = false;
      change(frame);
      const TrackedFrame& tracked = tracker_.track(frame, map_);
      frame.world_from_camera = tracked.world_from_camera;
      if (tracked.tracked) fixture::fuse(frame, map_);
    }
  }
  /// The only doubt; empty: there is none.
  std::string doubt() const {
    const auto doubts = sensor_doubts(tracker_);
    EXPECT_LE(doubts.size(), 1u);
    return doubts.empty() ? "" : doubts.front();
  }
  RgbImage color_at(double at) const { return camera_.take(pose(at)).color; }

  fixture::RoomCamera camera_;
  VoxelMap map_ = fixture::coarse_map();
  Tracker tracker_{TrackConfig{}};
};

TEST_F(SensorDoubts, NothingIsSaidOfASoundCamera) {
  walk(60, [](Frame&) {});
  EXPECT_EQ(doubt(), "");
  ASSERT_TRUE(tracker_.sensor().log_focal_ratio());
  EXPECT_LT(std::fabs(tracker_.sensor().log_focal_ratio()->value), 0.02);
  ASSERT_TRUE(tracker_.sensor().color_delay());
  EXPECT_LT(std::fabs(tracker_.sensor().color_delay()->value), 0.2);
}

TEST_F(SensorDoubts, AWrongFocalLengthIsTold) {
  walk(60, [](Frame& frame) {
    frame.depth_camera.fx *= 0.88f, frame.depth_camera.fy *= 0.88f;
    frame.color_camera = frame.depth_camera;
  });
  EXPECT_NE(doubt().find("larger than given; check fx and fy"), std::string::npos) << doubt();
}

TEST_F(SensorDoubts, ColourOfAnotherMomentThanDepthIsTold) {
  walk(60, [&](Frame& frame) { frame.color = color_at(static_cast<double>(frame.index) + 2); });
  EXPECT_NE(doubt().find("later than the depth"), std::string::npos) << doubt();
  ASSERT_TRUE(tracker_.sensor().color_delay());
  EXPECT_LT(tracker_.sensor().color_delay()->value, 2.5);
}

TEST_F(SensorDoubts, ColourThatIsEarlierIsToldToo) {
  walk(60, [&](Frame& frame) { frame.color = color_at(static_cast<double>(frame.index) - 1.5); });
  EXPECT_NE(doubt().find("earlier than the depth"), std::string::npos) << doubt();
}

TEST_F(SensorDoubts, PosesOfAnotherMomentThanFramesAreTold) {
  walk(90, [](Frame& frame) {
    frame.posed = true;
    frame.world_from_camera = pose(static_cast<double>(frame.index) - 3.4);
  });
  EXPECT_NE(doubt().find("3.4 frames earlier"), std::string::npos) << doubt();
}

/// Odometry that drifts and errs is not late.
TEST_F(SensorDoubts, RoughPosesInTimeAreNotDoubted) {
  Pose off = Pose::Identity();
  walk(90, [&](Frame& frame) {
    Vector6d drift;
    const double turn = frame.index % 2 == 0 ? 0.01 : -0.006;
    drift << 0.004, 0, -0.003, 0, turn, turn;
    off = off * small_motion(drift);
    frame.posed = true;
    frame.world_from_camera = frame.world_from_camera * off;
  });
  EXPECT_EQ(doubt(), "");
}

}  // namespace
}  // namespace ovimap
