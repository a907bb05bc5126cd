// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/relations/footprint.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace ovimap {
namespace {

using PlanPoint = Eigen::Vector2f;

Footprint rectangle(float x0, float y0, float x1, float y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

Footprint random_hull(std::mt19937& engine, const PlanPoint& center) {
  std::uniform_real_distribution<float> uniform(-1.f, 1.f);
  std::vector<PlanPoint> points;
  for (int i = 0; i < 12; ++i)
    points.push_back(center + PlanPoint(uniform(engine), uniform(engine)));
  return convex_hull(points);
}

TEST(Footprint, HullOfASquareWithPointsInsideAndOnItsEdges) {
  const Footprint hull = convex_hull({{0, 0}, {2, 2}, {1, 1}, {2, 0}, {1, 0}, {0, 2}, {0, 0}});
  EXPECT_EQ(hull.size(), 4u);
  EXPECT_FLOAT_EQ(area_m2(hull), 4.f);  // positive: counter-clockwise
  EXPECT_FLOAT_EQ(perimeter_m(hull), 8.f);
  EXPECT_EQ(convex_hull({{0, 0}, {1, 1}, {2, 2}}).size(), 2u);
  EXPECT_EQ(convex_hull({{1, 1}, {1, 1}}).size(), 1u);
}

TEST(Footprint, SmallestWidthOfATurnedRectangle) {
  std::vector<PlanPoint> corners = rectangle(0, 0, 3, 0.2f);
  const Eigen::Rotation2Df turned(0.7f);
  for (PlanPoint& corner : corners) corner = turned * corner;
  EXPECT_NEAR(smallest_width_m(convex_hull(corners)), 0.2f, 1e-5f);
}

TEST(Footprint, DistancesByHand) {
  const Footprint a = rectangle(0, 0, 1, 1);
  EXPECT_FLOAT_EQ(distance_m(a, PlanPoint(0.5f, 0.5f)), 0.f);
  EXPECT_FLOAT_EQ(distance_m(a, PlanPoint(3.f, 0.5f)), 2.f);
  EXPECT_FLOAT_EQ(distance_m(a, PlanPoint(4.f, 5.f)), 5.f);
  EXPECT_FLOAT_EQ(distance_m(a, rectangle(1.5f, 0, 2, 1)), 0.5f);
  EXPECT_FLOAT_EQ(distance_m(a, rectangle(0.2f, 0.2f, 0.4f, 0.4f)), 0.f);
  EXPECT_FLOAT_EQ(distance_m(a, rectangle(-1, 0.4f, 2, 0.6f)), 0.f);  // a cross: no corner inside
  EXPECT_FLOAT_EQ(overlap_m2(a, rectangle(0.5f, -1, 2, 2)), 0.5f);
  EXPECT_FLOAT_EQ(overlap_m2(a, rectangle(2, 2, 3, 3)), 0.f);
}

TEST(Footprint, OverlapAgreesWithSampling) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> uniform(-1.f, 1.f);
  for (int round = 0; round < 20; ++round) {
    const Footprint a = random_hull(engine, {0, 0}), b = random_hull(engine, {0.6f, 0.3f});
    int inside = 0;
    constexpr int kSamples = 20000;
    for (int i = 0; i < kSamples; ++i) {
      const PlanPoint point(uniform(engine), uniform(engine));
      inside += distance_m(a, point) == 0.f && distance_m(b, point) == 0.f;
    }
    EXPECT_NEAR(overlap_m2(a, b), 4.f * static_cast<float>(inside) / kSamples, 0.06f);
    EXPECT_NEAR(overlap_m2(a, b), overlap_m2(b, a), 1e-4f);
  }
}

TEST(Footprint, DistanceAgreesWithSamplingTheEdges) {
  std::mt19937 engine(4);
  for (int round = 0; round < 20; ++round) {
    const Footprint a = random_hull(engine, {0, 0}), b = random_hull(engine, {2.5f, 1.f});
    float smallest = 1e9f;
    for (std::size_t i = 0; i < b.size(); ++i)
      for (int step = 0; step < 200; ++step) {
        const PlanPoint p =
            b[i] + static_cast<float>(step) / 200.f * (b[(i + 1) % b.size()] - b[i]);
        smallest = std::min(smallest, distance_m(a, p));
      }
    EXPECT_NEAR(distance_m(a, b), smallest, 0.01f);
  }
}

}  // namespace
}  // namespace ovimap
