// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/tracker.h"

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"
#include "ovimap/track/room_camera_fixture.h"

namespace ovimap {
namespace {

class TrackerTest : public ::testing::Test {
 protected:
  /// Tracks a frame taken at a true pose; the first one's pose is the world.
  const TrackedFrame& see(const Pose& pose) { return see(camera_.take(pose, next_)); }
  const TrackedFrame& see(const Frame& frame) {
    if (next_++ == 0) first_ = frame.world_from_camera;
    return fixture::track_and_fuse(tracker_, frame, map_);
  }
  double off_m(const TrackedFrame& tracked, const Pose& truth) const {
    return fixture::distance_m(first_ * tracked.world_from_camera, truth);
  }
  Frame dark() {
    Frame frame = camera_.take(fixture::room_pose(0), next_);
    frame.depth.fill(0);
    frame.color.fill({0, 0, 0});
    return frame;
  }

  fixture::RoomCamera camera_;
  VoxelMap map_ = fixture::coarse_map();
  Tracker tracker_{TrackConfig{}};
  Pose first_ = Pose::Identity();
  std::int64_t next_ = 0;
};

TEST_F(TrackerTest, FollowsACamera) {
  for (int i = 0; i < 40; ++i) {
    const TrackedFrame& tracked = see(fixture::room_pose(i));
    ASSERT_TRUE(tracked.tracked) << i;
    EXPECT_LT(off_m(tracked, fixture::room_pose(i)), 0.015) << i;
  }
  EXPECT_EQ(summary_line(summarise(tracker_.log())), "tracked 40 of 40 frames, lost 0 times");
}

TEST_F(TrackerTest, FollowsEveryThirdFrame) {
  camera_.camera = {320, 240, 280.f, 280.f, 159.5f, 119.5f};  // of four levels, as cameras' are
  for (int i = 0; i < 60; i += 3) {
    const TrackedFrame& tracked = see(fixture::room_pose(i));
    ASSERT_TRUE(tracked.tracked) << i;
    EXPECT_LT(off_m(tracked, fixture::room_pose(i)), 0.02) << i;
  }
}

TEST_F(TrackerTest, RefusesImagesTooSmallToSeeMotion) {
  camera_.camera = {64, 48, 56.f, 56.f, 31.5f, 23.5f};
  try {
    see(fixture::room_pose(0));
    FAIL();
  } catch (const Error& fault) {
    EXPECT_NE(std::string(fault.what()).find("depth images are 64 pixels wide"), std::string::npos);
  }
  camera_.camera = {80, 60, 70.f, 70.f, 39.5f, 29.5f};  // the smallest that are taken
  EXPECT_TRUE(see(fixture::room_pose(0)).tracked);
  EXPECT_TRUE(see(fixture::room_pose(0)).tracked);
}

TEST_F(TrackerTest, FollowsAFastPan) {  // 120 degrees a second at 30 frames a second
  for (int i = 0; i < 30; ++i) {
    Pose pose = fixture::room_pose(0);
    pose.rotate(Eigen::AngleAxisd(i * 4 * M_PI / 180, Eigen::Vector3d::UnitY()));
    const TrackedFrame& tracked = see(pose);
    ASSERT_TRUE(tracked.tracked) << i;
    EXPECT_LT(off_m(tracked, pose), 0.03) << i;
  }
}

TEST_F(TrackerTest, CoveredLensIsLostUntilItIsUncovered) {
  for (int i = 0; i < 10; ++i) see(fixture::room_pose(i));
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(see(dark()).tracked);
  const TrackedFrame& found = see(fixture::room_pose(8));
  EXPECT_TRUE(found.tracked);
  EXPECT_TRUE(found.relocated);
  EXPECT_LT(off_m(found, fixture::room_pose(8)), 0.02);
  EXPECT_EQ(summary_line(summarise(tracker_.log())),
            "tracked 11 of 16 frames, lost 1 time (frames 10 to 14)");
}

TEST_F(TrackerTest, TeleportIsFoundAmongThePlacesSeen) {
  for (int i = 0; i < 40; ++i) see(fixture::room_pose(i));
  const TrackedFrame& back = see(fixture::room_pose(1));
  EXPECT_TRUE(back.tracked);
  EXPECT_LT(off_m(back, fixture::room_pose(1)), 0.03);
}

/// Another place is not this one: neither tracked nor, by whoever fuses tracked frames, mapped.
TEST_F(TrackerTest, AnotherPlaceIsLost) {
  for (int i = 0; i < 10; ++i) see(fixture::room_pose(i));
  Pose behind = fixture::room_pose(0);
  behind.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()));
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(see(behind).tracked);
  EXPECT_TRUE(see(fixture::room_pose(9)).tracked);
}

TEST_F(TrackerTest, FirstFrameWithDepthIsTheWorld) {
  EXPECT_FALSE(see(dark()).tracked);
  const TrackedFrame& first = see(fixture::room_pose(0));
  EXPECT_TRUE(first.tracked);
  EXPECT_TRUE(first.world_from_camera.isApprox(Pose::Identity()));
}

TEST_F(TrackerTest, BeginsInAMapThatIsThere) {
  std::vector<Keyframe> places;
  for (int i = 0; i < 30; i += 10) {
    const Frame frame = camera_.take(fixture::room_pose(i), i);
    fixture::fuse(frame, map_);
    places.push_back(make_keyframe(make_pyramid(frame), i, frame.world_from_camera));
  }
  tracker_.begin_in(places);
  const TrackedFrame& found = see(fixture::room_pose(11));
  ASSERT_TRUE(found.tracked);
  EXPECT_LT(fixture::distance_m(found.world_from_camera, fixture::room_pose(11)), 0.02);
}

TEST(Tracker, IsTheSameForAnyNumberOfThreads) {
  const auto last_pose = [](int threads) {
    const ThreadLimit limit(threads);
    const fixture::RoomCamera camera;
    VoxelMap map = fixture::coarse_map();
    Tracker tracker{TrackConfig{}};
    for (int i = 0; i < 12; ++i)
      fixture::track_and_fuse(tracker, camera.take(fixture::room_pose(i), i), map);
    return tracker.log().back().world_from_camera.matrix();
  };
  EXPECT_EQ(last_pose(1), last_pose(3));
}

}  // namespace
}  // namespace ovimap
