// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/visit_fit.h"

#include <gtest/gtest.h>

#include "ovimap/pipeline/mapping/furnished_fixture.h"

namespace ovimap {
namespace {

FurnishedRoom furnished(const Pose& world_from_room = Pose::Identity()) {
  FurnishedRoom room;
  room.things = {furniture(-0.9f, 0.9f, {0.6f, 0.4f, 0.5f}, {190, 120, 40}),
                 furniture(0.6f, 0.3f, {0.3f, 0.3f, 0.3f}, {220, 20, 20})};
  room.world_from_room = world_from_room;
  return room;
}

VisitFit fit_of(const VoxelMap& map, const FurnishedRoom& room) {
  std::vector<std::int64_t> all;
  for (std::int64_t i = 0; i < room.frames; ++i) all.push_back(i);
  return fit_visit(map, room, all, {}, {});
}

TEST(VisitFit, ARecordingOfTheRoomFits) {
  const MapDocument map = map_of(furnished());
  const VisitFit fit = fit_of(map.map, furnished());
  EXPECT_GT(fit.compared, 8);
  EXPECT_LT(fit.offset_m, 0.008);
  EXPECT_EQ(misfit(fit, {}), "");
}

TEST(VisitFit, ThingsThatMovedSpeakNotAgainstIt) {
  const MapDocument map = map_of(furnished());
  FurnishedRoom moved = furnished();
  moved.things[1] = furniture(-0.6f, -0.6f, {0.3f, 0.3f, 0.3f}, {220, 20, 20});
  EXPECT_EQ(misfit(fit_of(map.map, moved), {}), "");
}

TEST(VisitFit, PosesThreeCentimetresOffAreTold) {
  const MapDocument map = map_of(furnished());
  Pose off = Pose::Identity();
  off.translation() = Eigen::Vector3d(0.02, 0.02, 0.012);
  const VisitFit fit = fit_of(map.map, furnished(off));
  EXPECT_GT(fit.offset_m, 0.02);
  EXPECT_NE(misfit(fit, {}).find("cm and"), std::string::npos);
  EXPECT_LT((fit.map_from_recording * off).translation().norm(), 0.01) << "where it lies is known";
}

TEST(VisitFit, OfMotionsTheMiddleOneIsTaken) {
  EXPECT_TRUE(middle_motion({}, {}).isApprox(Pose::Identity()));
  const auto motion = [](double metres, double turn_rad) {
    Pose pose = Pose::Identity();
    pose.translation().x() = metres;
    pose.rotate(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY()));
    return pose;
  };
  const std::vector<Pose> cameras(4, Pose::Identity());
  EXPECT_TRUE(middle_motion(cameras, {motion(1, 0), motion(1.1, 0), motion(1.3, 0), motion(9, 0)})
                  .isApprox(motion(1.1, 0)));
  EXPECT_TRUE(middle_motion(cameras, {motion(1, 0.5), motion(1, 0.1), motion(1, 0), motion(1, 0)})
                  .isApprox(motion(1, 0)));
}

TEST(VisitFit, AnotherPlaceIsTold) {
  const MapDocument map = map_of(furnished());
  Pose away = Pose::Identity();
  away.translation() = Eigen::Vector3d(20, 0, 0);
  EXPECT_NE(misfit(fit_of(map.map, furnished(away)), {}).find("none of its frames"),
            std::string::npos);
}

}  // namespace
}  // namespace ovimap
