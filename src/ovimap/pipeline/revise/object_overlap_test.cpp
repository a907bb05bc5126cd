// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/object_overlap.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

/// Objects that are strips along x, each given as (id, from, to), points 1 cm apart.
struct Strip {
  InstanceId id;
  float from, to, y;
};

MapRecord map_of(const std::vector<Strip>& strips) {
  MapRecord map;
  for (const Strip& strip : strips) {
    map.instances.emplace_back().id = strip.id;
    std::vector<Eigen::Vector3f>& points = map.surfaces[strip.id];
    for (float x = strip.from + 0.005f; x < strip.to; x += 0.01f)
      points.emplace_back(x, strip.y, 0.f);
  }
  return map;
}

TEST(ObjectOverlap, CountsWhatLiesAtTheSamePlace) {
  const auto found = overlaps(map_of({{1, 0.f, 2.f, 0.f}, {2, 0.f, 1.f, 1.f}}),
                              map_of({{7, 1.f, 2.f, 0.f}}), Pose::Identity(), 0.004f);
  ASSERT_EQ(found.size(), 1u);
  const ObjectOverlap& overlap = found.at({1, 7});
  EXPECT_NEAR(overlap.share_a, 0.5f, 0.01f);
  EXPECT_NEAR(overlap.share_b, 1.f, 0.01f);
  EXPECT_NEAR(overlap.iou, 0.5f, 0.01f);
  EXPECT_NEAR(overlap.shared_points, 100.f, 1.5f);
}

TEST(ObjectOverlap, IsJudgedApartWhereBothMapsHaveSurface) {
  // A counter of which each map saw another end, and a shelf that one map saw whole.
  const auto found =
      overlaps(map_of({{1, 0.f, 2.2f, 0.f}, {2, 0.f, 4.f, 1.f}}),
               map_of({{7, 1.8f, 4.f, 0.f}, {8, 0.f, 4.f, 1.f}}), Pose::Identity(), 0.004f);
  EXPECT_NEAR(found.at({1, 7}).iou, 0.1f, 0.01f);
  EXPECT_NEAR(found.at({1, 7}).common_iou, 1.f, 0.02f);
  EXPECT_NEAR(found.at({2, 8}).common_iou, found.at({2, 8}).iou, 0.01f);
}

TEST(ObjectOverlap, NeighboursThatMeetShareLittleOfWhatBothMapsHave) {
  // Where one map ends the counter, the other still goes on: the rest is of the next object.
  const auto found =
      overlaps(map_of({{1, 0.f, 1.f, 0.f}, {2, 1.f, 2.f, 0.f}}),
               map_of({{7, 0.f, 1.2f, 0.f}, {8, 1.2f, 2.f, 0.f}}), Pose::Identity(), 0.004f);
  EXPECT_GT(found.at({1, 7}).common_iou, 0.8f);
  EXPECT_LT(found.at({2, 7}).common_iou, 0.12f);
}

TEST(ObjectOverlap, MovesTheSecondMap) {
  Pose moved = Pose::Identity();
  moved.translation().y() = 3.0;
  const auto found =
      overlaps(map_of({{1, 0.f, 1.f, 3.f}}), map_of({{7, 0.f, 1.f, 0.f}}), moved, 0.004f);
  EXPECT_NEAR(found.at({1, 7}).iou, 1.f, 0.01f);
}

}  // namespace
}  // namespace ovimap
