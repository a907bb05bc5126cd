// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/geometry/convex_hull.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

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
