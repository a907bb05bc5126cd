// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/thing_look.h"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

/// Points 2 cm apart on the top of a box and on the first `sides` of its four sides, about their
/// mean, turned about the vertical.
ThingLook box_look(const Eigen::Vector3f& size, int sides, float turn = 0.f) {
  constexpr float kStep = 0.02f;
  ThingLook look;
  const auto sheet = [&](const Eigen::Vector3f& from, const Eigen::Vector3f& u,
                         const Eigen::Vector3f& v) {
    for (float a = 0.f; a <= u.norm(); a += kStep)
      for (float b = 0.f; b <= v.norm(); b += kStep)
        look.points.push_back(from + a * u.normalized() + b * v.normalized());
  };
  const Eigen::Vector3f x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  const Eigen::Vector3f origin = Eigen::Vector3f::Zero();
  sheet(z, x, y);
  if (sides > 0) sheet(origin, x, z);
  if (sides > 1) sheet(origin, y, z);
  if (sides > 2) sheet(y, x, z);
  if (sides > 3) sheet(x, y, z);
  const Eigen::AngleAxisf turned(turn, Eigen::Vector3f::UnitZ());
  Eigen::Vector3f mean = origin;
  for (Eigen::Vector3f& point : look.points) mean += point = turned * point;
  mean /= static_cast<float>(look.points.size());
  float squares = 0;
  for (Eigen::Vector3f& point : look.points) squares += (point -= mean).squaredNorm();
  look.reach_m = std::sqrt(squares / static_cast<float>(look.points.size()));
  return look;
}

TEST(ThingLook, AThingIsLikeItselfHoweverItIsTurned) {
  constexpr float kTurn = 40.f * std::numbers::pi_v<float> / 180.f;
  const ThingLook box = box_look({0.4f, 0.2f, 0.3f}, 4),
                  turned = box_look({0.4f, 0.2f, 0.3f}, 4, kTurn);
  EXPECT_LT(shape_distance(box, turned), 0.05f);
  EXPECT_LT(shape_distance(turned, box), 0.05f);
}

TEST(ThingLook, AThingSeenFromOneSideLiesOnItselfSeenFromAll) {
  // Their means are a good part of its size apart.
  const ThingLook whole = box_look({0.4f, 0.3f, 0.5f}, 4), half = box_look({0.4f, 0.3f, 0.5f}, 2);
  EXPECT_LT(shape_distance(whole, half), 0.13f);
}

TEST(ThingLook, AnotherShapeLiesOffIt) {
  const ThingLook box = box_look({0.4f, 0.3f, 0.5f}, 4);
  EXPECT_GT(shape_distance(box, box_look({0.9f, 0.1f, 0.1f}, 4)), 0.25f);
  EXPECT_GT(shape_distance(box, box_look({0.4f, 0.3f, 1.2f}, 4)), 0.15f);
  EXPECT_EQ(shape_distance(box, ThingLook{}), 1.f) << "of nothing nothing is known";
}

/// The look of a thing of one colour, 0 to 255.
ThingLook painted(int red, int green, int blue) {
  constexpr InstanceId kThing = 3;
  MapDocument map;
  VoxelBlock& block = map.map.writable_block(map.map.find_or_create({0, 0, 0}));
  const auto fixed = [](int level) { return static_cast<std::uint16_t>(level << 8); };
  block.color.fill(pack_color({fixed(red), fixed(green), fixed(blue)}));
  map.surfaces[kThing] = {Eigen::Vector3f::Constant(0.01f), Eigen::Vector3f::Constant(0.03f)};
  return thing_look(map, kThing, Eigen::Vector3f::UnitZ());
}

TEST(ThingLook, AShadeLighterIsTheSameColor) {
  const ThingLook mug = painted(125, 60, 190);
  EXPECT_NEAR(common_colors(mug, mug), 1.f, 1e-5f);
  EXPECT_GT(common_colors(mug, painted(131, 66, 196)), 0.75f) << "on the other side of all cells";
  EXPECT_LT(common_colors(mug, painted(190, 125, 60)), 0.1f);
  EXPECT_NEAR(common_colors(painted(0, 0, 1), painted(1, 0, 0)), 1.f, 0.1f);
  EXPECT_LT(common_colors(painted(0, 0, 1), painted(255, 255, 255)), 1e-5f);
}

TEST(ThingLook, ColorsThatAreNotKnownSayNothing) {
  ThingLook red, blue;
  red.colors[0] = 1.f;
  blue.colors[5] = 0.75f;
  blue.colors[0] = 0.25f;
  EXPECT_FLOAT_EQ(common_colors(red, blue), 0.25f);
  EXPECT_FLOAT_EQ(common_colors(red, ThingLook{}), 1.f);
}

}  // namespace
}  // namespace ovimap
