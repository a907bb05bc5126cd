// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/tracker.h"

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/base/parallel.h"
#include "ovimap/track/room_camera_fixture.h"
#include "ovimap/track/sensor_doubts.h"

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
  const std::string fault = error_of([&] { see(fixture::room_pose(0)); });
  EXPECT_NE(fault.find("depth images are 64 pixels wide"), std::string::npos);
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

/// The camera passes close by a board that hides, piece by piece, all that it saw before, and what
/// comes out behind it was never seen: the surface must be cast anew while there is enough of it.
TEST_F(TrackerTest, GoesOnBehindWhatHidesTheView) {
  const Pose start = fixture::room_pose(0);
  const double board_z = 0.5, board_left = -0.9,
               board_right = -0.25;  // in the first camera's frame
  for (int i = 0; i < 40; ++i) {
    const double along = -0.03 * i;
    const Pose pose = start * Eigen::Translation3d(along, 0, 0);
    Frame frame = camera_.take(pose, next_);
    for (int y = 0; y < frame.depth.height(); ++y)
      for (int x = 0; x < frame.depth.width(); ++x) {
        const Eigen::Vector3d ray =
            camera_.camera.unproject(static_cast<float>(x), static_cast<float>(y), 1.f)
                .cast<double>();
        const Eigen::Vector3d point = board_z * ray + Eigen::Vector3d(along, 0, 0);
        if (point.x() < board_left || point.x() > board_right) continue;
        const Eigen::Vector3d place = 4 * point;
        frame.depth.at(x, y) = static_cast<float>(board_z);
        frame.color.at(x, y) = {camera_.shade(place, 0), camera_.shade(place, 1),
                                camera_.shade(place, 2)};
      }
    const TrackedFrame& tracked = see(frame);
    ASSERT_TRUE(tracked.tracked) << i;
    EXPECT_LT(off_m(tracked, pose), 0.03) << i;
  }
}

/// Bare walls hide some directions of the motion: the frames in which they do are told.
TEST_F(TrackerTest, WithoutTextureWhatDepthDoesNotTellIsTold) {
  camera_.textured = false;
  see(fixture::room_pose(0));
  double last_off_m = 0;
  for (int i = 1; i < 20; ++i) {
    const TrackedFrame& tracked = see(fixture::room_pose(i));
    const double off = off_m(tracked, fixture::room_pose(i));
    EXPECT_TRUE(!tracked.tracked || tracked.degenerate > 0 || off - last_off_m < 0.01) << i;
    last_off_m = off;
  }
  EXPECT_GT(summarise(tracker_.log()).degenerate, 0u);
}

/// Somebody walks through the picture, half as wide as it: what is not sure is lost, nothing is
/// believed to be where it is not, and where the camera was before it is found again.
TEST_F(TrackerTest, AMovingPersonDoesNotCarryTheCameraAlong) {
  for (int i = 0; i < 10; ++i) see(fixture::room_pose(i));
  for (int i = 10; i < 30; ++i) {
    Frame frame = camera_.take(fixture::room_pose(i), next_);
    const int width = frame.depth.width(), left = (i - 10) * width / 40;
    for (int y = 0; y < frame.depth.height(); ++y)
      for (int x = left; x < left + width / 2; ++x) {
        frame.depth.at(x, y) = 0.6f;
        const auto stripe = static_cast<std::uint8_t>((x - left) / 6 % 2 == 0 ? 40 : 200);
        frame.color.at(x, y) = {stripe, stripe, stripe};
      }
    const TrackedFrame& seen = see(frame);
    EXPECT_TRUE(!seen.tracked || off_m(seen, fixture::room_pose(i)) < 0.03) << i;
  }
  const TrackedFrame& found = see(fixture::room_pose(8));
  EXPECT_TRUE(found.tracked);
  EXPECT_LT(off_m(found, fixture::room_pose(8)), 0.02);
}

/// Two recordings in one file: what follows is another place. Nothing of it is believed, and what
/// comes back to the first place is.
TEST_F(TrackerTest, OfTwoRecordingsInOneTheFirstIsMapped) {
  const auto behind = [](int i) {
    Pose pose = fixture::room_pose(i);
    pose.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()));
    return pose;
  };
  for (int i = 0; i < 10; ++i) see(fixture::room_pose(i));
  const std::uint64_t before = map_.content_hash();
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(see(behind(i)).tracked) << i;
  EXPECT_EQ(map_.content_hash(), before);
  EXPECT_EQ(summary_line(summarise(tracker_.log())),
            "tracked 10 of 20 frames, lost 1 time (frames 10 to 19)");
}

/// A loop was closed: the camera and its places are elsewhere, and so is the map.
TEST_F(TrackerTest, GoesOnInAMapThatWasCorrected) {
  for (int i = 0; i < 10; ++i) see(fixture::room_pose(i));
  Vector6d shift;
  shift << 0.3, 0, -0.2, 0, 0.1, 0;
  const Pose moved = small_motion(shift);
  std::vector<Pose> poses;
  for (const Keyframe& keyframe : tracker_.keyframes())
    poses.push_back(moved * keyframe.world_from_camera);
  tracker_.correct(poses);
  map_ = fixture::coarse_map();
  for (int i = 0; i < 10; ++i) {
    Frame frame = camera_.take(fixture::room_pose(i), i);
    frame.world_from_camera = moved * first_.inverse() * fixture::room_pose(i);
    fixture::fuse(frame, map_);
  }
  first_ = first_ * moved.inverse();
  const TrackedFrame& tracked = see(fixture::room_pose(10));
  ASSERT_TRUE(tracked.tracked);
  EXPECT_FALSE(tracked.relocated);
  EXPECT_LT(off_m(tracked, fixture::room_pose(10)), 0.015);
}

/// A camera that turns on one spot and has a gyroscope, whose world is not the map's.
class GyroscopeTest : public TrackerTest {
 protected:
  static Pose turned(double degrees) {
    Pose pose = fixture::room_pose(0);
    pose.rotate(about_y(degrees));
    return pose;
  }
  static Eigen::AngleAxisd about_y(double degrees) {
    return {degrees * M_PI / 180, Eigen::Vector3d::UnitY()};
  }
  /// `says`: the degrees that the gyroscope gives.
  Frame frame(double degrees, double says) {
    Frame frame = camera_.take(turned(degrees), next_);
    frame.orientation = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5) * about_y(says);
    return frame;
  }
  const TrackedFrame& turn_to(double degrees) { return see(frame(degrees, degrees)); }
  void forget() { tracker_ = Tracker(TrackConfig{}), map_ = fixture::coarse_map(), next_ = 0; }
};

/// So fast that the images alone do not tell how far: the reach of a shift of images is 20 degrees.
TEST_F(GyroscopeTest, FollowsTurnsThatImagesCannotTell) {
  for (int i = 0; i < 8; ++i) {
    const TrackedFrame& tracked = turn_to(28 * i);
    ASSERT_TRUE(tracked.tracked) << i;
    EXPECT_LT(off_m(tracked, turned(28 * i)), 0.01) << i;
  }
  forget();
  for (int i = 0; i < 8; ++i) see(turned(28 * i));
  EXPECT_EQ(summarise(tracker_.log()).tracked, 1u);
}

TEST_F(GyroscopeTest, FollowsTurnsBeforeBareWalls) {
  camera_.textured = false;
  for (int i = 0; i < 8; ++i) {
    const TrackedFrame& tracked = turn_to(16 * i);
    ASSERT_TRUE(tracked.tracked) << i;
    EXPECT_LT(off_m(tracked, turned(16 * i)), 0.02) << i;
  }
  forget();
  for (int i = 0; i < 8; ++i) see(turned(16 * i));
  EXPECT_EQ(summarise(tracker_.log()).tracked, 1u);
}

/// The lens is covered while the camera turns back to where it looked before.
TEST_F(GyroscopeTest, IsFoundAtOnceWhereItTurnedWhileTheLensWasCovered) {
  camera_.textured = false;
  for (const bool gyroscope : {true, false}) {
    forget();
    for (int i = 0; i < 20; ++i) turn_to(4 * i);
    for (int i = 0; i < 10; ++i) EXPECT_FALSE(see(dark()).tracked);
    const TrackedFrame& found = gyroscope ? turn_to(23) : see(turned(23));
    EXPECT_EQ(found.tracked, gyroscope);
    EXPECT_TRUE(!gyroscope || off_m(found, turned(23)) < 0.01);
  }
}

/// It says how the camera turned, not that it is where it was.
TEST_F(GyroscopeTest, AnotherPlaceIsLostWhateverTheGyroscopeSays) {
  for (int i = 0; i < 10; ++i) turn_to(2 * i);
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(see(frame(180 + 2 * i, 20 + 2 * i)).tracked) << i;
  EXPECT_TRUE(turn_to(18).tracked);
}

/// Mounted the other way round: the images are believed, and what is wrong is told.
TEST_F(GyroscopeTest, AMistakenGyroscopeCostsNoFrame) {
  for (int i = 0; i < 60; ++i) {
    const double degrees = 25 * std::sin(0.1 * i);
    const TrackedFrame& tracked = see(frame(degrees, -degrees));
    ASSERT_TRUE(tracked.tracked) << i;
    EXPECT_LT(off_m(tracked, turned(degrees)), 0.01) << i;
  }
  EXPECT_TRUE(tracker_.gyroscope().is_contradicted());
  const auto doubts = sensor_doubts(tracker_);
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_NE(doubts[0].find("the gyroscope says otherwise than the images"), std::string::npos);
}

TEST_F(GyroscopeTest, OneThatDriftsIsNotDoubted) {
  for (int i = 0; i < 60; ++i) {
    const double degrees = 25 * std::sin(0.1 * i);
    ASSERT_TRUE(see(frame(degrees, degrees + 0.1 * i)).tracked) << i;  // 3 degrees a second
  }
  EXPECT_GT(tracker_.gyroscope().compared(), 30);
  EXPECT_FALSE(tracker_.gyroscope().is_contradicted());
  EXPECT_TRUE(sensor_doubts(tracker_).empty());
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

/// A map without keyframes, and places of which something else says where in it they lie.
class ProposedPlaces : public TrackerTest {
 protected:
  ProposedPlaces() {
    for (int i = 0; i < 30; i += 10) fixture::fuse(camera_.take(fixture::room_pose(i), i), map_);
    tracker_.begin_in({});
  }
  Keyframe place(const Pose& taken_at, const Pose& said_to_be_at) const {
    return make_keyframe(make_pyramid(camera_.take(taken_at)), 0, said_to_be_at);
  }
};

TEST_F(ProposedPlaces, AreBelievedWhereTheMapHasTheSame) {
  Pose near = fixture::room_pose(11);
  near.translation() += Eigen::Vector3d(0.05, -0.04, 0.03);
  tracker_.propose({place(fixture::room_pose(11), near)});
  const TrackedFrame& found = see(fixture::room_pose(11));
  ASSERT_TRUE(found.relocated);
  EXPECT_LT(fixture::distance_m(found.world_from_camera, fixture::room_pose(11)), 0.06)
      << "7 cm off as proposed; depth does not tell every direction here";
  EXPECT_EQ(tracker_.keyframes().size(), 1u) << "the frame's own";
}

TEST_F(ProposedPlaces, AreNotBelievedWhereItHasAnother) {
  Pose wrong = fixture::room_pose(11);
  wrong.rotate(Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitY()));
  tracker_.propose({place(fixture::room_pose(11), wrong)});
  EXPECT_FALSE(see(fixture::room_pose(11)).tracked);
}

TEST_F(ProposedPlaces, AreNotBelievedWhereItHasNothing) {
  Pose outside = fixture::room_pose(11);
  outside.translation() += Eigen::Vector3d(50, 0, 0);
  tracker_.propose({place(fixture::room_pose(11), outside)});
  EXPECT_FALSE(see(fixture::room_pose(11)).tracked);
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
