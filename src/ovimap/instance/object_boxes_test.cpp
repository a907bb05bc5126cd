// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/object_boxes.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

constexpr float kSpacing_m = 0.02f;

using Points = std::vector<Eigen::Vector3f>;

/// A square of points in the plane z = `z_m`.
Points square(float from_m, float to_m, float z_m) {
  Points points;
  for (float y = from_m; y <= to_m; y += kSpacing_m)
    for (float x = from_m; x <= to_m; x += kSpacing_m) points.emplace_back(x, y, z_m);
  return points;
}

void append(const Points& more, Points& points) {
  points.insert(points.end(), more.begin(), more.end());
}

TEST(ObjectBoxes, LeaveSpecksOut) {
  Points points = square(0.f, 0.4f, 0.5f);
  points.emplace_back(3.f, -2.f, 0.f);    // across the room
  points.emplace_back(0.2f, 0.2f, 0.7f);  // behind it
  points.emplace_back(0.2f, 0.2f, 0.71f);
  const Eigen::AlignedBox3f box = box_without_specks(points, kSpacing_m);
  EXPECT_NEAR(box.min().x(), 0.f, 1e-3f);
  EXPECT_NEAR(box.min().y(), 0.f, 1e-3f);
  EXPECT_NEAR(box.max().x(), 0.4f, 0.03f);
  EXPECT_NEAR(box.min().z(), 0.5f, 1e-3f);
  EXPECT_NEAR(box.max().z(), 0.5f, 1e-3f);
}

TEST(ObjectBoxes, HoldWhatIsSeenInTwoPieces) {
  Points points = square(0.f, 0.4f, 0.5f);
  append(square(0.8f, 1.1f, 0.5f), points);
  EXPECT_NEAR(box_without_specks(points, kSpacing_m).max().x(), 1.1f, 0.03f);
}

TEST(ObjectBoxes, FollowAThinThing) {
  Points points = square(0.f, 0.1f, 0.f);
  for (float z = 0.f; z < 1.5f; z += kSpacing_m) points.emplace_back(0.05f, 0.05f, z);  // a lamp
  EXPECT_NEAR(box_without_specks(points, kSpacing_m).max().z(), 1.5f, 0.03f);
}

TEST(ObjectBoxes, StayWhereNoSurfaceIsKnown) {
  std::vector<InstanceSummary> instances(2);
  instances[0].id = 4;
  instances[0].box = {Eigen::Vector3f::Zero(), Eigen::Vector3f::Ones()};
  instances[1].id = 7;
  fit_boxes({{7, {Eigen::Vector3f::Ones()}}}, kSpacing_m, instances);
  EXPECT_EQ(instances[0].box.max(), Eigen::Vector3f::Ones());
  EXPECT_EQ(instances[1].box.min(), Eigen::Vector3f::Ones());
  EXPECT_TRUE(box_without_specks({}, kSpacing_m).isEmpty());
}

}  // namespace
}  // namespace ovimap
