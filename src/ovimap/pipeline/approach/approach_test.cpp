// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/approach/approach.h"

#include <gtest/gtest.h>

#include "ovimap/pipeline/mapping/furnished_fixture.h"

namespace ovimap {
namespace {

/// A chest in the middle of the room, and a low box behind it as seen from the west.
class ApproachTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    FurnishedRoom room;
    room.frames = 32;
    room.things = {furniture(0.f, 0.f, {0.4f, 0.4f, 0.8f}, {200, 40, 40}),
                   furniture(0.7f, 0.f, {0.2f, 0.2f, 0.2f}, {40, 200, 40})};
    const MapDocument document = map_of(room, MapDocument(), false);
    space = make_standing_space(document);
    chest = object_at(document, Pose::Identity(), 0.f, 0.f, 0.4f);
    box = object_at(document, Pose::Identity(), 0.7f, 0.f, 0.1f);
  }
  ApproachTest() {
    robot.radius_m = 0.15f;
    robot.camera_height_m = 0.5f;
    robot.range_m = 1.2f;
  }

  inline static StandingSpace space;
  inline static InstanceId chest = 0, box = 0;
  ApproachConfig robot;
};

TEST_F(ApproachTest, SeesWhatItLooksAtAndKeepsClear) {
  ASSERT_NE(chest, 0u);
  ASSERT_NE(box, 0u);
  const Approach approach = find_approach(space, box, robot);
  ASSERT_FALSE(approach.poses.empty()) << approach.reason;
  for (const ApproachPose& pose : approach.poses) {
    const Eigen::Vector2f to_box = Eigen::Vector2f(0.7f, 0.f) - pose.place_m;
    EXPECT_NEAR(std::remainder(pose.yaw_rad - std::atan2(to_box.y(), to_box.x()), 2 * M_PI), 0.,
                0.15);
    EXPECT_LT(pose.tilt_rad, 0.f);
    EXPECT_GE(pose.seen, robot.least_seen);
    const bool behind_chest = pose.place_m.x() < -0.1f && std::abs(pose.place_m.y()) < 0.4f;
    EXPECT_FALSE(behind_chest) << "it is hidden there: " << pose.place_m.transpose();
    EXPECT_LE(to_box.norm(), robot.range_m + 0.2f);
    EXPECT_GE(to_box.cwiseAbs().maxCoeff(), 0.1f + robot.radius_m - 0.03f);
    EXPECT_TRUE(pose.way.empty());
  }
}

TEST_F(ApproachTest, GoesTheShorterWay) {
  const Eigen::Vector2f start(0.7f, -1.2f);
  const Approach approach = find_approach(space, box, robot, start);
  ASSERT_FALSE(approach.poses.empty()) << approach.reason;
  const ApproachPose& first = approach.poses.front();
  EXPECT_LT(first.place_m.y(), 0.2f) << "not round to the other side";
  ASSERT_GE(first.way.size(), 2u);
  EXPECT_LT((first.way.front() - start).norm(), 2 * robot.radius_m);
  EXPECT_TRUE(first.way.back().isApprox(first.place_m));
  EXPECT_GE(first.way_m, (first.place_m - first.way.front()).norm() - 1e-4f);
}

TEST_F(ApproachTest, SaysWhyNot) {
  const auto reason = [&](InstanceId id, const std::optional<Eigen::Vector2f>& from) {
    const Approach approach = find_approach(space, id, robot, from);
    EXPECT_TRUE(approach.poses.empty());
    return approach.reason;
  };
  EXPECT_NE(reason(987654, std::nullopt).find("no surface"), std::string::npos);
  EXPECT_NE(reason(box, Eigen::Vector2f(50.f, 0.f)).find("cannot be at (50"), std::string::npos);
  robot.radius_m = 1.5f;
  EXPECT_NE(reason(box, std::nullopt).find("no free place"), std::string::npos);
  robot.radius_m = 0.15f;
  robot.least_seen = 1.f;
  EXPECT_NE(reason(chest, std::nullopt).find("no more than"), std::string::npos);
}

TEST_F(ApproachTest, TheWorldMayLieOnItsSide) {
  FurnishedRoom room;
  room.things = {furniture(0.f, 0.f, {0.4f, 0.4f, 0.8f}, {200, 40, 40})};
  room.world_from_room.linear() =
      Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, 2, 0).normalized()).toRotationMatrix();
  const MapDocument tilted = map_of(room, MapDocument(), false);
  const StandingSpace there = make_standing_space(tilted);
  const InstanceId id = object_at(tilted, room.world_from_room.inverse(), 0.f, 0.f, 0.4f);
  const Approach approach = find_approach(there, id, robot);
  ASSERT_FALSE(approach.poses.empty()) << approach.reason;
  const Eigen::Vector3f in_grid(approach.poses[0].place_m.x(), approach.poses[0].place_m.y(),
                                there.grid.floor_m);
  const Eigen::Vector3f in_room = room.world_from_room.linear().transpose().cast<float>() *
                                  there.grid.grid_from_world.transpose() * in_grid;
  EXPECT_NEAR(in_room.z(), 0.f, 0.05f);
  EXPECT_LT(in_room.head<2>().norm(), 2.f);
}

}  // namespace
}  // namespace ovimap
