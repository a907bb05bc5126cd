// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include <gtest/gtest.h>

#include "ovimap/synth/rooms/room_layout.h"
#include "ovimap/synth/shapes/height_map.h"
#include "ovimap/synth/shapes/mesh_parts.h"
#include "ovimap/synth/shapes/oriented_box.h"

namespace ovimap {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

TEST(OrientedBox, OverlapIsTheShallowestDepth) {
  const OrientedBox a{{0, 0}, {1, 0.5f}, 0, 0, 1};
  const OrientedBox beside{{1.8f, 0}, {1, 1}, 0, 0, 1}, apart{{2.5f, 0}, {1, 1}, 0, 0, 1};
  EXPECT_NEAR(overlap(a, beside), 0.2f, 1e-6f);
  EXPECT_NEAR(overlap(a, apart), -0.5f, 1e-6f);
  OrientedBox above = a;
  above.bottom_m = 1.1f, above.top_m = 2;
  EXPECT_NEAR(overlap(a, above), -0.1f, 1e-6f);
  EXPECT_GT(footprint_overlap(a, above), 0.9f);
}

TEST(OrientedBox, ATurnedBoxTouchesWithItsCorner) {
  const OrientedBox a{{0, 0}, {1, 1}, 0, 0, 1}, diamond{{2.5f, 0}, {1, 1}, kPi / 4, 0, 1};
  EXPECT_NEAR(overlap(a, diamond), 1 + std::sqrt(2.f) - 2.5f, 1e-5f);
}

TEST(HeightMap, ThingsRestOnFlatPartsOnly) {
  TexturedMesh mesh;  // a step: 0.4 high for x < 0, 0.7 high beyond
  add_box(mesh, {-0.5f, -0.5f, 0}, {0, 0.5f, 0.4f}, 0);
  add_box(mesh, {0, -0.5f, 0}, {0.5f, 0.5f, 0.7f}, 0);
  const HeightMap map(mesh);
  const auto rest = [&](float x, float half) {
    return map.rest({{x, 0}, {half, half}, 0.3f, 0, 1}, 0.005f);
  };
  EXPECT_NEAR(rest(-0.25f, 0.1f).value(), 0.4f, 1e-5f);
  EXPECT_NEAR(rest(0.25f, 0.1f).value(), 0.7f, 1e-5f);
  EXPECT_FALSE(rest(0.05f, 0.1f).has_value());  // across the step
  EXPECT_FALSE(rest(0.45f, 0.1f).has_value());  // over the edge
}

class RoomLayoutTest : public testing::Test {
 protected:
  RoomLayout layout_{{4, 3, 2.5f}, 11};
};

TEST_F(RoomLayoutTest, WallPiecesStandBackToTheWall) {
  for (int i = 0; i < 4; ++i) {
    const auto box = layout_.against_wall({1, 0.4f, 1});
    ASSERT_TRUE(box.has_value());
    layout_.add(*box);
    const OrientedBox front = RoomLayout::space_in_front(*box, 0.1f);
    EXPECT_TRUE(front.inside({4, 3}, 0));
    // Just behind its back is the wall.
    const Eigen::Vector2f behind = box->world_from_box({0, box->half_m.y() + 0.021f});
    EXPECT_TRUE(behind.minCoeff() < 0 || behind.x() > 4 || behind.y() > 3) << behind.transpose();
  }
}

TEST_F(RoomLayoutTest, NothingOverlapsAndAFullRoomIsSaid) {
  int placed = 0;
  for (int i = 0; i < 200; ++i)
    if (const auto box = layout_.on_floor({0.4f, 0.3f, 0.5f})) layout_.add(*box), ++placed;
  EXPECT_GT(placed, 15);
  EXPECT_LT(placed, 200);
  const auto& pieces = layout_.pieces();
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) EXPECT_LE(overlap(pieces[i], pieces[k]), 0);
}

TEST_F(RoomLayoutTest, ChairsFaceTheirTable) {
  const OrientedBox table{{2, 1.5f}, {0.6f, 0.35f}, 0, 0, 0.75f};
  layout_.add(table);
  for (int i = 0; i < 3; ++i) {
    const auto chair = layout_.around(table, {0.45f, 0.5f, 0.9f});
    ASSERT_TRUE(chair.has_value());
    layout_.add(*chair);
    const Eigen::Vector2f seen = chair->world_from_box({0, -0.6f});
    EXPECT_GT(footprint_overlap(table, {seen, {0.01f, 0.01f}, 0, 0, 1}), 0);
  }
}

TEST_F(RoomLayoutTest, ThingsOnTopStandOnTheirCarrier) {
  TexturedMesh mesh;
  add_box(mesh, {-0.6f, -0.35f, 0}, {0.6f, 0.35f, 0.75f}, 0);
  const std::size_t table = layout_.add({{2, 1.5f}, {0.6f, 0.35f}, 0.5f, 0, 0.75f});
  const HeightMap upper(mesh);
  for (int i = 0; i < 4; ++i) {
    const auto box = layout_.on_top(table, upper, {0.2f, 0.15f, 0.1f}, false);
    ASSERT_TRUE(box.has_value());
    EXPECT_NEAR(box->bottom_m, 0.75f, 1e-3f);
    EXPECT_GE(box->bottom_m, 0.75f);
    for (const OrientedBox& other : layout_.pieces()) EXPECT_LE(overlap(*box, other), 0);
    layout_.add(*box);
  }
}

TEST_F(RoomLayoutTest, SpacesKeptClearStayClear) {
  layout_.keep_clear({{2, 1.5f}, {1.9f, 1.2f}, 0, 0, 2});
  EXPECT_FALSE(layout_.in_middle({0.5f, 0.5f, 0.5f}).has_value());
}

TEST(YawFacing, TurnsTheFrontIntoTheDirection) {
  for (const Eigen::Vector2f& direction : {Eigen::Vector2f(1, 0), {0, 1}, {-0.6f, 0.8f}}) {
    const OrientedBox box{{0, 0}, {1, 1}, yaw_facing(direction), 0, 1};
    EXPECT_TRUE((-box.y_axis()).isApprox(direction, 1e-5f));
  }
}

}  // namespace
}  // namespace ovimap
