// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/rooms/room_outline.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

/// Rows from the top, as the plan's picture has them; cells of half a metre from (10, 20).
RoomPlan plan_of(const std::vector<std::string>& rows) {
  RoomPlan plan;
  plan.floor =
      Image<std::uint16_t>(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()));
  for (int y = 0; y < plan.floor.height(); ++y)
    for (int x = 0; x < plan.floor.width(); ++x)
      plan.floor.at(x, y) = static_cast<std::uint16_t>(
          rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] - '0');
  plan.origin = {10, 20};
  plan.cell_m = 0.5f;
  return plan;
}

float area(const Polygon& polygon) {
  float twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2f &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

TEST(RoomOutline, AroundARoomInMetres) {
  const auto outline = room_outline(plan_of({"00000", "01110", "01110", "01110", "00000"}), 1);
  ASSERT_EQ(outline.size(), 1u);
  EXPECT_EQ(outline[0].size(), 4u);
  EXPECT_FLOAT_EQ(area(outline[0]), 9 * 0.25f) << "counter-clockwise";
  EXPECT_EQ(outline[0][0], Eigen::Vector2f(10.5f, 20.5f));
}

TEST(RoomOutline, WhatStandsInARoomIsLeftOut) {
  std::vector<std::string> rows(9, "111111111");
  for (std::size_t y = 3; y < 6; ++y) rows[y] = "111000111";
  const auto outline = room_outline(plan_of(rows), 1);
  ASSERT_EQ(outline.size(), 2u);
  EXPECT_FLOAT_EQ(area(outline[0]), 81 * 0.25f);
  EXPECT_FLOAT_EQ(area(outline[1]), -9 * 0.25f) << "clockwise";
}

TEST(RoomOutline, StairsOfCellsBecomeLines) {
  std::vector<std::string> rows;
  for (int y = 0; y < 20; ++y)
    rows.push_back(std::string(static_cast<std::size_t>(20 - y), '2') +
                   std::string(static_cast<std::size_t>(y), '1'));
  const auto outline = room_outline(plan_of(rows), 2);
  ASSERT_EQ(outline.size(), 1u);
  EXPECT_LE(outline[0].size(), 5u);
  EXPECT_NEAR(area(outline[0]), 210 * 0.25f, 6.f);
}

TEST(RoomOutline, PartsThatMeetAtACornerStayApart) {
  const auto outline =
      room_outline(plan_of({"333000", "333000", "333000", "000333", "000333", "000333"}), 3);
  ASSERT_EQ(outline.size(), 2u);
  for (const Polygon& part : outline) EXPECT_FLOAT_EQ(area(part), 9 * 0.25f);
  EXPECT_TRUE(room_outline(plan_of({"333"}), 1).empty());
}

}  // namespace
}  // namespace ovimap
