// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/camera/walk.h"

#include <algorithm>
#include <filesystem>
#include <numbers>

#include <gtest/gtest.h>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"
#include "ovimap/synth/buildings/room_builder.h"
#include "ovimap/synth/camera/small_camera_fixture.h"
#include "ovimap/synth/furniture/furniture_catalog.h"

namespace ovimap {
namespace {

using fixture::kSmallCamera;
constexpr double kStep_s = 1. / 240;  // much shorter than a tremor

Walk walk_in(const SynthRoom& room, const WalkConfig& config = {}) {
  const RayScene scene(room.objects);
  return plan_walk(room, scene, kSmallCamera, config);
}

double turn_between(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(Eigen::Matrix3d(a.linear().transpose() * b.linear())).angle();
}

/// How far the eye is from the nearest thing that stands at its height or below it.
float clearance(const SynthRoom& room, const Eigen::Vector3d& eye) {
  const Eigen::Vector2f place = eye.head<2>().cast<float>();
  float least = std::min(place.minCoeff(), (room.size_m.head<2>() - place).minCoeff());
  for (const RoomObject& object : room.objects) {
    if (!object.footprint || object.footprint->top_m < 0.1f) continue;
    if (object.footprint->bottom_m > static_cast<float>(eye.z())) continue;
    const float gap = -footprint_overlap(*object.footprint, {place, {0, 0}, 0, 0, 2});
    least = std::min(least, gap);
  }
  return least;
}

TEST(PlaneSpline, GoesStraightAtTheSpeedOfItsPoints) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 10; ++i) points.emplace_back(0.5 * i, 1);
  const PlaneSpline line(points, 0.25, false);
  EXPECT_NEAR(line.at(1.1).x(), 2.2, 1e-12);
  EXPECT_NEAR(line.at(1.1).y(), 1, 1e-12);
  EXPECT_TRUE(line.at(100).isApprox(points.back(), 1e-12));  // rests at its end
}

TEST(PlaneSpline, AClosedOneComesBack) {
  const PlaneSpline ring({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.5, true);
  EXPECT_EQ(ring.seconds(), 2);
  EXPECT_TRUE(ring.at(0.3).isApprox(ring.at(2.3), 1e-12));
  EXPECT_TRUE(ring.at(-0.1).isApprox(ring.at(1.9), 1e-12));
}

TEST(WalkTest, SpeedAndTurnsAreBoundedAndSmooth) {
  const SynthRoom room = build_room(room_spec("bare"));
  const WalkConfig config;
  const Walk walk = walk_in(room, config);
  // Sway, drift and tremor at their fastest, all at once.
  constexpr double kTurn = 2 * std::numbers::pi;
  const double shaken_mps = kTurn * (config.steps_per_s * (config.rise_m + config.sideways_m / 2) +
                                     0.4 * 2 * config.drift_m + 12 * 2 * config.tremor_m) +
                            config.sideways_m * config.max_turn_rad_s;
  const double shaken_rad_s = kTurn * (config.steps_per_s * (config.nod_rad + config.roll_rad / 2) +
                                       0.4 * 2 * config.drift_rad + 12 * 2 * config.tremor_rad);
  double fastest_mps = 0, length_m = 0;
  for (double t = 0; t < walk.seconds(); t += kStep_s) {
    const Pose a = walk.at(t), b = walk.at(t + kStep_s), c = walk.at(t + 2 * kStep_s);
    EXPECT_TRUE(pose_fault(a.matrix()).empty());
    const Eigen::Vector3d step = b.translation() - a.translation();
    const Eigen::Vector3d next = c.translation() - b.translation();
    fastest_mps = std::max(fastest_mps, step.norm() / kStep_s);
    length_m += step.norm();
    EXPECT_LT(turn_between(a, b) / kStep_s, config.max_turn_rad_s + shaken_rad_s);
    // No jerks: nobody's hand accelerates by a g.
    EXPECT_LT((next - step).norm() / (kStep_s * kStep_s), 9.81);
    EXPECT_LT(std::abs(turn_between(b, c) - turn_between(a, b)) / (kStep_s * kStep_s), 20);
  }
  EXPECT_LT(fastest_mps, config.speed_mps + shaken_mps);
  EXPECT_NEAR(length_m / walk.seconds(), config.speed_mps, 0.25 * config.speed_mps);
}

TEST(WalkTest, WhipsThePanAsFastAsAsked) {
  const SynthRoom room = build_room(room_spec("bare"));
  WalkConfig config;
  config.max_turn_rad_s = 0.15f;
  config.nod_rad = config.roll_rad = config.drift_rad = config.tremor_rad = 0;
  config.whip_rad_s = 2.1f;
  const Walk walk = walk_in(room, config);
  double fastest_rad_s = 0;
  for (double t = 0; t < walk.seconds(); t += kStep_s) {
    const double turn = turn_between(walk.at(t), walk.at(t + kStep_s));
    const double next = turn_between(walk.at(t + kStep_s), walk.at(t + 2 * kStep_s));
    fastest_rad_s = std::max(fastest_rad_s, turn / kStep_s);
    EXPECT_LT(std::abs(next - turn) / (kStep_s * kStep_s), 20) << t;
  }
  EXPECT_NEAR(fastest_rad_s, 2.1, 0.15);
}

TEST(WalkTest, ComesBackToWhereItBegan) {
  WalkConfig still;
  still.rise_m = still.sideways_m = still.drift_m = still.tremor_m = 0;
  const Walk walk = walk_in(build_room(room_spec("bare")), still);
  EXPECT_NEAR((walk.at(walk.seconds()).translation() - walk.at(0).translation()).norm(), 0, 1e-9);
}

TEST(WalkTest, LastsAsLongAsAskedAndDependsOnTheSeedAlone) {
  WalkConfig config;
  config.seconds = 7.5f;
  const SynthRoom room = build_room(room_spec("bare"));
  const Walk walk = walk_in(room, config);
  EXPECT_EQ(walk.seconds(), 7.5);
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    EXPECT_TRUE(walk_in(room, config).at(3.21).isApprox(walk.at(3.21), 0));
  }
  SynthRoom other = room;
  other.seed = 2;
  EXPECT_FALSE(walk_in(other, config).at(3.21).isApprox(walk.at(3.21), 1e-4));
}

TEST(WalkTest, ARoomWithoutRoomIsSaid) {
  SynthRoom room = build_room(room_spec("bare"));
  RoomObject block;
  block.footprint = OrientedBox{room.size_m.head<2>() / 2, room.size_m.head<2>() / 2, 0, 0, 2};
  room.objects.push_back(block);
  EXPECT_THROW(walking_round(room, {}, 0.2), Error);
}

class FurnishedWalk : public testing::TestWithParam<std::string> {};

TEST_P(FurnishedWalk, KeepsClearOfFurnitureAndWalls) {
  if (!std::filesystem::exists(default_furniture_folder()))
    GTEST_SKIP() << "the Debian package sweethome3d-furniture is not installed";
  const SynthRoom room = build_room(room_spec(GetParam()));
  const WalkConfig config;
  const PlaneSpline path(walking_round(room, config, 0.175), 0.25, true);
  float least = 1;
  for (double t = 0; t < path.seconds(); t += 0.02) {
    const Eigen::Vector2d place = path.at(t);
    least = std::min(least, clearance(room, {place.x(), place.y(), config.eye_m}));
  }
  RecordProperty("seconds", std::to_string(path.seconds()));
  // Half the body's radius, less half a cell of the map and what a bend of the spline cuts off;
  // what is left is more than sway and drift together take.
  EXPECT_GT(least, config.sideways_m + config.drift_m) << path.seconds() << " s";
}

INSTANTIATE_TEST_SUITE_P(EveryRoom, FurnishedWalk,
                         testing::Values("tiny", "living-room", "bedroom", "kitchen", "office",
                                         "bathroom"),
                         [](const auto& room) {
                           std::string name = room.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace ovimap
