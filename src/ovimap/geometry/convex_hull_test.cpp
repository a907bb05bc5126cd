// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/geometry/convex_hull.h"

#include <random>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

/// Points one after the other, few at a time.
std::vector<Eigen::Vector2f> hull_step_by_step(const std::vector<Eigen::Vector2f>& points) {
  std::vector<Eigen::Vector2f> hull;
  for (std::size_t i = 0; i < points.size(); ++i) {
    hull.push_back(points[i]);
    if (i % 10 == 9 || i + 1 == points.size()) hull = convex_hull(hull);
  }
  return hull;
}

TEST(ConvexHull, OfManyIsThatOfThemOneAfterTheOther) {
  std::mt19937 random(5);
  std::normal_distribution<float> around(0.f, 0.2f);
  for (const float flat : {1.f, 1e-2f, 0.f}) {
    std::vector<Eigen::Vector2f> points;
    for (int i = 0; i < 3000; ++i)
      points.emplace_back(80.f + around(random) + around(random), -40.f + flat * around(random));
    const std::vector<Eigen::Vector2f> hull = convex_hull(points);
    EXPECT_EQ(hull, hull_step_by_step(points)) << flat;
    EXPECT_GE(hull.size(), 2u);
    EXPECT_LT(hull.size(), 60u);
  }
}

TEST(ConvexHull, OfAGridIsItsCorners) {
  std::vector<Eigen::Vector2f> points;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 30; ++x)
      points.emplace_back(0.02f * static_cast<float>(x), 0.02f * static_cast<float>(y));
  EXPECT_EQ(convex_hull(points).size(), 4u);
}

TEST(SmallestRectangle, LiesAlongAnEdgeOfWhatItHolds) {
  const Eigen::Vector2f along(0.8f, 0.6f), across(-0.6f, 0.8f), middle(3, -2);
  std::vector<Eigen::Vector2f> points{middle};
  for (const float u : {-2.f, 2.f})
    for (const float v : {-0.5f, 0.5f}) points.push_back(middle + u * along + v * across);
  const PlaneRectangle found = smallest_rectangle(convex_hull(points));
  EXPECT_LT((found.center - middle).norm(), 1e-5f);
  EXPECT_NEAR(found.sides.maxCoeff(), 4.f, 1e-5f);
  EXPECT_NEAR(found.sides.minCoeff(), 1.f, 1e-5f);
  const bool first = found.sides.x() > found.sides.y();
  EXPECT_NEAR(std::abs((first ? found.along : found.across()).dot(along)), 1.f, 1e-6f);
}

TEST(SmallestRectangle, OfNoEdgesHasNoSides) {
  EXPECT_TRUE(smallest_rectangle({}).sides.isZero());
  const std::vector<Eigen::Vector2f> point{{1, 2}};
  EXPECT_TRUE(smallest_rectangle(point).sides.isZero());
}

}  // namespace
}  // namespace ovimap
