// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/relations/relations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

#include "ovimap/base/config.h"

namespace ovimap {
namespace {

using Point = Eigen::Vector3f;

// A room, z up, metres. The viewer stands at x = -5 and looks along +x, so left is +y.
const Eigen::Matrix3f kGround = Eigen::Matrix3f::Identity();
const GroundViewpoint kViewer{{-5.f, 0.f}, {1.f, 0.f}};
constexpr InstanceId kId = 12;

ObjectShape box(const Point& low, const Point& high) {
  const Eigen::AlignedBox3f bounds(low, high);
  return shape_of_box(kGround, bounds, bounds.center());
}

void add_sheet(std::vector<Point>& points, const Point& low, const Point& high) {
  constexpr float kStep = 0.02f;
  for (float x = low.x(); x <= high.x(); x += kStep)
    for (float y = low.y(); y <= high.y(); y += kStep)
      for (float z = low.z(); z <= high.z(); z += kStep) points.emplace_back(x, y, z);
}

/// Seat at 0.45 m, back up to 0.9 m at x = 0.4.
ObjectShape chair_with_surface() {
  std::vector<Point> points;
  add_sheet(points, {0, 0, 0.45f}, {0.4f, 0.4f, 0.45f});
  add_sheet(points, {0.4f, 0, 0.45f}, {0.4f, 0.4f, 0.9f});
  for (const float x : {0.f, 0.4f})
    for (const float y : {0.f, 0.4f}) add_sheet(points, {x, y, 0}, {x, y, 0.45f});
  return shape_of_points(kGround, points);
}

float score(Relation relation, const ObjectShape& a, const ObjectShape& b) {
  return rate_relation(relation, a, b, kId, kViewer, {}).score;
}

const ObjectShape kFloor = box({-4, -4, -0.05f}, {4, 4, 0});
const ObjectShape kTable = box({0, 0, 0}, {1.6f, 0.8f, 0.75f});
const ObjectShape kMug = box({0.3f, 0.3f, 0.76f}, {0.4f, 0.4f, 0.86f});
const ObjectShape kBoxUnder = box({0.5f, 0.2f, 0}, {0.9f, 0.6f, 0.3f});
const ObjectShape kWall = box({2, -4, 0}, {2.1f, 4, 2.5f});
const ObjectShape kPicture = box({1.95f, 0, 1.2f}, {1.99f, 0.8f, 1.8f});
const ObjectShape kLamp = box({0.7f, 0.3f, 1.8f}, {0.9f, 0.5f, 2.0f});
const ObjectShape kChairBeside = box({0.4f, -0.7f, 0}, {0.8f, -0.3f, 0.9f});

TEST(Relations, On) {
  EXPECT_GT(score(Relation::kOn, kMug, kTable), 0.9f);
  EXPECT_LT(score(Relation::kOn, kMug, kFloor), 0.1f);
  EXPECT_GT(score(Relation::kOn, kTable, kFloor), 0.9f);
  EXPECT_LT(score(Relation::kOn, kTable, kMug), 0.1f);
  EXPECT_LT(score(Relation::kOn, kLamp, kTable), 0.1f);
  EXPECT_LT(score(Relation::kOn, kBoxUnder, kTable), 0.1f);
  EXPECT_LT(score(Relation::kOn, kChairBeside, kTable), 0.1f);
}

TEST(Relations, OnAWall) {
  EXPECT_GT(score(Relation::kOn, kPicture, kWall), 0.9f);
  EXPECT_LT(score(Relation::kOn, kLamp, kWall), 0.1f);
  // A kettle that touches a tall cabinet beside it does not hang on it.
  const ObjectShape cabinet = box({0, 0, 0}, {0.6f, 0.6f, 2});
  const ObjectShape kettle = box({0.61f, 0.2f, 0.9f}, {0.8f, 0.4f, 1.15f});
  EXPECT_LT(score(Relation::kOn, kettle, cabinet), 0.1f);
}

TEST(Relations, OnTheSeatOfAChair) {
  const ObjectShape cat = box({0.1f, 0.1f, 0.47f}, {0.3f, 0.3f, 0.7f});
  const ObjectShape chair = chair_with_surface();
  EXPECT_NEAR(chair.top_m, 0.9f, 0.02f);
  const RelationRating rating = rate_relation(Relation::kOn, cat, chair, kId, kViewer, {});
  EXPECT_GT(rating.score, 0.9f);
  EXPECT_NE(rating.evidence.find("a part of #12"), std::string::npos) << rating.evidence;
  const ObjectShape prism = box({0, 0, 0}, {0.4f, 0.4f, 0.9f});  // the box alone cannot tell
  EXPECT_LT(score(Relation::kOn, cat, prism), 0.1f);
}

TEST(Relations, EvidenceSaysTheDistance) {
  EXPECT_EQ(rate_relation(Relation::kOn, kMug, kTable, kId, kViewer, {}).evidence,
            "0.01 m above the top of #12");
  EXPECT_EQ(rate_relation(Relation::kAbove, kLamp, kTable, 3, kViewer, {}).evidence,
            "1.05 m above #3");
  EXPECT_EQ(rate_relation(Relation::kNear, kChairBeside, kTable, 3, kViewer, {}).evidence,
            "0.30 m from #3");
}

TEST(Relations, UnderAndAbove) {
  EXPECT_GT(score(Relation::kUnder, kBoxUnder, kTable), 0.9f);
  EXPECT_LT(score(Relation::kUnder, kMug, kTable), 0.1f);
  EXPECT_GT(score(Relation::kUnder, kTable, kMug), 0.5f);
  EXPECT_GT(score(Relation::kUnder, kTable, kLamp), 0.9f);
  EXPECT_LT(score(Relation::kUnder, kChairBeside, kTable), 0.3f);
  EXPECT_GT(score(Relation::kAbove, kLamp, kTable), 0.9f);
  EXPECT_LT(score(Relation::kAbove, kTable, kLamp), 0.1f);
  EXPECT_LT(score(Relation::kAbove, kBoxUnder, kTable), 0.1f);
  // A picture on the wall behind a sofa is above it, though not over it.
  const ObjectShape sofa = box({1.0f, -0.5f, 0}, {1.85f, 1.5f, 0.8f});
  EXPECT_GT(score(Relation::kAbove, kPicture, sofa), 0.9f);
  EXPECT_GT(score(Relation::kUnder, sofa, kPicture), 0.9f);
  EXPECT_LT(score(Relation::kUnder, kPicture, sofa), 0.1f);
}

TEST(Relations, BesideAndNear) {
  EXPECT_GT(score(Relation::kBeside, kChairBeside, kTable), 0.8f);
  EXPECT_GT(score(Relation::kBeside, kTable, kChairBeside), 0.8f);
  EXPECT_LT(score(Relation::kBeside, kMug, kTable), 0.2f);
  EXPECT_LT(score(Relation::kBeside, kBoxUnder, kTable), 0.2f);
  EXPECT_GT(score(Relation::kNear, kMug, kTable), 0.9f);
  const ObjectShape far = box({10, 10, 0}, {11, 11, 1});
  EXPECT_LT(score(Relation::kBeside, far, kTable), 0.01f);
  EXPECT_LT(score(Relation::kNear, far, kTable), 0.01f);
}

TEST(Relations, Inside) {
  const ObjectShape cabinet = box({3, 0, 0}, {4, 1, 2});
  const ObjectShape plate = box({3.2f, 0.2f, 1.2f}, {3.5f, 0.5f, 1.25f});
  EXPECT_GT(score(Relation::kInside, plate, cabinet), 0.99f);
  EXPECT_LT(score(Relation::kInside, cabinet, plate), 0.01f);
  EXPECT_LT(score(Relation::kUnder, plate, cabinet), 0.1f);
  EXPECT_LT(score(Relation::kInside, kMug, kTable), 0.01f);
  const ObjectShape half_out = box({3.9f, 0.2f, 1}, {4.1f, 0.4f, 1.2f});
  EXPECT_NEAR(score(Relation::kInside, half_out, cabinet), 0.5f, 0.01f);
}

TEST(Relations, SidesAreTheViewers) {
  const ObjectShape middle = box({-0.5f, -0.5f, 0}, {0.5f, 0.5f, 1});
  const ObjectShape left = box({-0.2f, 1, 0}, {0.2f, 1.4f, 1});
  const ObjectShape before = box({-1.6f, -0.2f, 0}, {-1.2f, 0.2f, 1});
  EXPECT_GT(score(Relation::kLeftOf, left, middle), 0.9f);
  EXPECT_LT(score(Relation::kRightOf, left, middle), 0.01f);
  EXPECT_GT(score(Relation::kRightOf, middle, left), 0.9f);
  EXPECT_GT(score(Relation::kInFrontOf, before, middle), 0.9f);
  EXPECT_GT(score(Relation::kBehind, middle, before), 0.9f);
  EXPECT_LT(score(Relation::kBehind, before, middle), 0.01f);
  EXPECT_LT(score(Relation::kLeftOf, before, middle), 0.1f);
  // From the other side left is right.
  const GroundViewpoint opposite{{5.f, 0.f}, {-1.f, 0.f}};
  EXPECT_GT(rate_relation(Relation::kRightOf, left, middle, kId, opposite, {}).score, 0.9f);
  // A viewer who stands on the anchor looks where the camera does.
  const GroundViewpoint on_it{{0.f, 0.f}, {1.f, 0.f}};
  EXPECT_GT(rate_relation(Relation::kLeftOf, left, middle, kId, on_it, {}).score, 0.9f);
  EXPECT_EQ(rate_relation(Relation::kLeftOf, left, middle, kId, kViewer, {}).evidence,
            "0.70 m to the left of #12");
  // What lies over the anchor is on no side of it.
  EXPECT_EQ(score(Relation::kLeftOf, kMug, kTable), 0.f);
}

TEST(Relations, BetweenTwo) {
  const ObjectShape west = box({-3, 0, 0}, {-2, 1, 1}), east = box({2, 0, 0}, {3, 1, 1});
  const ObjectShape middle = box({-0.2f, 0.3f, 0}, {0.2f, 0.7f, 0.4f});
  const ObjectShape outside = box({5, 0.3f, 0}, {5.4f, 0.7f, 0.4f});
  EXPECT_GT(rate_between(middle, west, east, 1, 2).score, 0.99f);
  EXPECT_LT(rate_between(outside, west, east, 1, 2).score, 0.01f);
  const ObjectShape aside = box({-0.2f, 4, 0}, {0.2f, 4.4f, 0.4f});
  EXPECT_LT(rate_between(aside, west, east, 1, 2).score, 0.3f);
  EXPECT_EQ(rate_between(west, west, east, 1, 2).score, 0.f);
}

TEST(Relations, Superlatives) {
  const ObjectShape shelf = box({0, 0, 0}, {0.3f, 0.3f, 2});
  const ObjectShape rug = box({0, 0, 0}, {3, 2, 0.01f});
  const auto value = [](Superlative superlative, const ObjectShape& shape) {
    return measure(superlative, shape).value;
  };
  EXPECT_GT(value(Superlative::kLargest, rug), value(Superlative::kLargest, shelf));
  EXPECT_GT(value(Superlative::kSmallest, shelf), value(Superlative::kSmallest, rug));
  EXPECT_GT(value(Superlative::kTallest, shelf), value(Superlative::kTallest, kTable));
  EXPECT_GT(value(Superlative::kShortest, rug), value(Superlative::kShortest, kTable));
  EXPECT_GT(value(Superlative::kHighest, kLamp), value(Superlative::kHighest, kTable));
  EXPECT_GT(value(Superlative::kLowest, kTable), value(Superlative::kLowest, kLamp));
  EXPECT_EQ(measure(Superlative::kTallest, shelf).evidence, "a height of 2.00 m");
}

TEST(Relations, GapUsesTheSurfaceWhereItIsKnown) {
  // An L-shaped wall: the convex prism around it holds the whole room.
  std::vector<Point> points;
  add_sheet(points, {0, 0, 0}, {4, 0, 2});
  add_sheet(points, {0, 0, 0}, {0, 4, 2});
  const ObjectShape walls = shape_of_points(kGround, points);
  const ObjectShape plant = box({1, 1, 0}, {1.4f, 1.4f, 1});
  EXPECT_EQ(distance_m(walls.footprint, plant.footprint), 0.f);
  EXPECT_NEAR(gap_m(walls, plant), 1.f, 0.03f);
  EXPECT_NEAR(gap_m(plant, walls), 1.f, 0.03f);
  const ObjectShape picture = box({2, 0.01f, 1}, {2.5f, 0.03f, 1.5f});
  EXPECT_GT(score(Relation::kOn, picture, walls), 0.9f);
}

/// A bumpy ground of 40,000 points, in the order of no walk, is asked about in groups of points.
TEST(Relations, LargeSurfacesAnswerAsAllOfTheirPointsDo) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-5.f, 5.f), height(0.f, 0.4f);
  std::vector<Point> points(40000);
  for (Point& point : points) point = {place(random), place(random), height(random)};
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return std::tuple(std::floor(a.x()), a.y()) < std::tuple(std::floor(b.x()), b.y());
  });
  const ObjectShape ground = shape_of_points(kGround, points);
  ASSERT_GT(ground.groups.size(), 10U);
  for (int i = 0; i < 50; ++i) {
    const Point low(1.5f * place(random), 1.5f * place(random), 2 * height(random));
    const ObjectShape thing = box(low, low + Point(0.3f, 0.2f, 0.5f));
    float gap = std::numeric_limits<float>::max(), support = std::numeric_limits<float>::lowest();
    for (const Point& point : ground.surface) {
      const float aside = distance_m(thing.footprint, point.head<2>()),
                  off = std::max({thing.bottom_m - point.z(), point.z() - thing.top_m, 0.f});
      gap = std::min(gap, std::hypot(aside, off));
      if (aside <= 0.05f && point.z() <= thing.middle_m()) support = std::max(support, point.z());
    }
    EXPECT_NEAR(gap_m(thing, ground), gap, 1e-5f);
    EXPECT_EQ(support_height_m(thing, ground, 0.05f), support);
  }
}

TEST(Relations, WorkInAWorldWithAnotherAxisUp) {
  // The same table and mug with y up and everything turned by 30 degrees about it.
  const Eigen::Matrix3f turn =
      (Eigen::AngleAxisf(0.5f, Point::UnitY()) * Eigen::AngleAxisf(-1.5707964f, Point::UnitX()))
          .toRotationMatrix();
  const Eigen::Matrix3f ground = ground_from_world(turn * Point::UnitZ());
  EXPECT_NEAR(ground.determinant(), 1.f, 1e-5f);
  EXPECT_TRUE((ground * (turn * Point::UnitZ())).isApprox(Point::UnitZ(), 1e-5f));
  std::vector<Point> table, mug;
  add_sheet(table, {0, 0, 0.75f}, {1.6f, 0.8f, 0.75f});
  add_sheet(mug, {0.3f, 0.3f, 0.76f}, {0.4f, 0.4f, 0.86f});
  for (Point& point : table) point = turn * point;
  for (Point& point : mug) point = turn * point;
  const ObjectShape a = shape_of_points(ground, mug), b = shape_of_points(ground, table);
  EXPECT_NEAR(area_m2(b.footprint), 1.28f, 0.05f);
  EXPECT_GT(score(Relation::kOn, a, b), 0.9f);
  EXPECT_LT(score(Relation::kOn, b, a), 0.1f);
}

TEST(Relations, TrimsStrayPoints) {
  std::vector<Point> points;
  add_sheet(points, {0, 0, 0}, {0.5f, 0.5f, 0.5f});
  points.emplace_back(0.2f, 0.2f, 3.f);
  EXPECT_NEAR(shape_of_points(kGround, points).top_m, 0.5f, 0.03f);
}

TEST(Relations, ConfigListsItsFields) {
  RelationConfig config;
  ConfigFields fields;
  fields.group("relations", [&](ConfigFields& inner) { list_fields(config, inner); });
  fields.set("relations.near_m", "2.5");
  EXPECT_FLOAT_EQ(config.near_m, 2.5f);
}

TEST(Relations, NoneIsRatedHigherThanItsBoxesAllow) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-2.f, 2.f), size(0.02f, 1.5f);
  std::vector<ObjectShape> shapes = {kFloor, kTable, kMug, kWall, kPicture, chair_with_surface()};
  while (shapes.size() < 40) {
    const Point low(place(random), place(random), 0.5f * (place(random) + 2.f));
    shapes.push_back(box(low, low + Point(size(random), size(random), size(random))));
  }
  const RelationConfig config;
  int spared = 0;
  for (const ObjectShape& a : shapes)
    for (const ObjectShape& b : shapes) {
      if (&a == &b) continue;
      for (const Relation relation :
           {Relation::kOn, Relation::kUnder, Relation::kAbove, Relation::kBeside, Relation::kNear,
            Relation::kInside, Relation::kLeftOf, Relation::kRightOf, Relation::kInFrontOf,
            Relation::kBehind}) {
        const float highest = highest_rating(relation, upright_box(a), upright_box(b), config);
        EXPECT_LE(score(relation, a, b), highest) << static_cast<int>(relation);
        if (highest < kRelationHolds) ++spared;
      }
    }
  EXPECT_GT(spared, 5000) << "of 15,600, or it spares nothing";
}

}  // namespace
}  // namespace ovimap
