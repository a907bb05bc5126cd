// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/graph/loop_closure.h"

#include <gtest/gtest.h>

#include "ovimap/track/room_camera_fixture.h"

namespace ovimap {
namespace {

/// Poses around a circle and back to its start, by steps that turn a little too far.
struct DriftingCircle {
  explicit DriftingCircle(int count) {
    for (int i = 0; i <= count; ++i) {
      const double angle = 2 * M_PI * i / count;
      Pose pose = Pose::Identity();
      pose.translation() = 2 * Eigen::Vector3d(std::sin(angle), 0, 1 - std::cos(angle));
      pose.linear() = Eigen::AngleAxisd(angle, -Eigen::Vector3d::UnitY()).matrix();
      truth.push_back(pose);
    }
    Vector6d drift;
    drift << 0.002, 0.001, -0.001, 0, 0.004, 0;
    estimate.push_back(truth.front());
    for (std::size_t i = 1; i < truth.size(); ++i) {
      const Pose step = truth[i - 1].inverse() * truth[i] * small_motion(drift);
      estimate.push_back(estimate.back() * step);
      edges.push_back({i - 1, i, step, 0.003, 0.004, false});
    }
  }
  double furthest(const std::vector<Pose>& poses) const {
    double furthest = 0;
    for (std::size_t i = 0; i < poses.size(); ++i)
      furthest = std::max(furthest, (poses[i].translation() - truth[i].translation()).norm());
    return furthest;
  }
  PoseEdge closing() const {
    return {0, truth.size() - 1, truth.front().inverse() * truth.back(), 0.005, 0.003, true};
  }

  std::vector<Pose> truth, estimate;
  std::vector<PoseEdge> edges;
};

TEST(PoseGraph, ALoopTakesTheDriftBack) {
  DriftingCircle circle(40);
  EXPECT_GT(circle.furthest(circle.estimate), 0.2);
  circle.edges.push_back(circle.closing());
  EXPECT_LT(circle.furthest(optimise_poses(circle.estimate, circle.edges)), 0.05);
}

TEST(PoseGraph, AWrongLoopPullsLittle) {
  DriftingCircle circle(40);
  circle.edges.push_back(circle.closing());
  circle.edges.push_back(circle.closing());
  PoseEdge wrong = circle.closing();
  wrong.from = 10, wrong.to = 30;
  wrong.from_to = Pose::Identity();
  circle.edges.push_back(wrong);
  const std::vector<Pose> poses = optimise_poses(circle.estimate, circle.edges);
  EXPECT_LT(circle.furthest(poses), 0.1);
  EXPECT_GT(edge_error(poses, wrong), 50);
}

TEST(LoopClosure, FindsThePlaceThatWasSeenAgain) {
  const fixture::RoomCamera camera;
  std::vector<Keyframe> keyframes;
  std::vector<Pose> truth;
  const auto add = [&](const Pose& real, const Pose& believed) {
    truth.push_back(real);
    keyframes.push_back(
        make_keyframe(make_pyramid(camera.take(real)), std::ssize(keyframes) * 10, believed));
  };
  const Pose start = fixture::room_pose(10);
  Vector6d drift;
  drift << 0.01, 0, 0.005, 0, 0.005, 0;
  Pose believed = start;
  Pose last = start;
  for (int i = 0; i <= 24; ++i) {  // once round while turning round
    const double angle = 2 * M_PI * i / 24;
    Pose real = start;
    real.translation() += 0.5 * Eigen::Vector3d(std::sin(angle), 0, 1 - std::cos(angle));
    real.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).matrix() * start.linear();
    believed = i == 0 ? real : Pose(believed * last.inverse() * real * small_motion(drift));
    last = real;
    add(real, believed);
  }
  LoopConfig config;
  config.min_path_m = 1.5f;
  const double before = fixture::distance_m(keyframes.back().world_from_camera, truth.back());
  const LoopClosure closure = close_loops(keyframes, {}, config);
  EXPECT_GT(before, 0.04);
  EXPECT_GT(closure.closed, 0u);
  EXPECT_LT(fixture::distance_m(closure.poses.back(), truth.back()), 0.02);
}

/// Looks round, goes away and comes back, tilted by more than two keyframes may differ.
struct TiltedReturn {
  TiltedReturn() {
    for (int i = -3; i <= 3; ++i) add(turned(start(), 0.3 * i, 0), turned(start(), 0.3 * i, 0));
    const Pose away = turned(start(), M_PI, 0);
    for (int i = 0; i <= 8; ++i) {
      Pose pose = away;
      pose.translation() += Eigen::Vector3d(0.25 * (i < 5 ? i : 8 - i), 0, 0);
      add(pose, drifted(pose));
    }
    config.min_path_m = 1.5f;
    config.min_similarity = 1;  // no code is so alike
  }
  static Pose start() { return fixture::room_pose(10); }
  static Pose turned(Pose pose, double yaw, double roll) {
    pose.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()));
    pose.rotate(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()));
    return pose;
  }
  static Pose drifted(Pose pose) {
    pose.translation() += Eigen::Vector3d(0.03, -0.01, 0.02);
    return pose;
  }
  static Pose back() {
    Pose pose = turned(start(), 0.1, 0.8);
    pose.translation() += Eigen::Vector3d(0.15, 0.05, 0.1);
    return pose;
  }
  void add(const Pose& real, const Pose& believed) {
    keyframes.push_back(
        make_keyframe(make_pyramid(camera.take(real)), std::ssize(keyframes) * 10, believed));
  }

  fixture::RoomCamera camera;
  std::vector<Keyframe> keyframes;
  LoopConfig config;
};

TEST(LoopClosure, APlaceIsKnownByWhatItsKeyframesShowTogether) {
  TiltedReturn way;
  const std::size_t before = close_loops(way.keyframes, {}, way.config).closed;
  way.add(TiltedReturn::back(), TiltedReturn::drifted(TiltedReturn::back()));
  const LoopClosure closure = close_loops(way.keyframes, {}, way.config);
  ASSERT_EQ(closure.closed, before + 1);
  EXPECT_LT(fixture::distance_m(closure.poses.back(), TiltedReturn::back()), 0.015);
}

TEST(LoopClosure, AnotherPlaceWhereOneWasExpectedIsNone) {
  TiltedReturn way;
  const std::size_t before = close_loops(way.keyframes, {}, way.config).closed;
  const Pose elsewhere = TiltedReturn::turned(TiltedReturn::back(), 2.4, 0);
  way.add(elsewhere, TiltedReturn::drifted(TiltedReturn::back()));
  EXPECT_EQ(close_loops(way.keyframes, {}, way.config).closed, before);
}

}  // namespace
}  // namespace ovimap
