// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/approach/ground_ways.h"

#include <gtest/gtest.h>

#include "ovimap/map/rays/distance_transform.h"

namespace ovimap {
namespace {

/// Rows from north to south; '#' occupied, '.' free, '?' unknown. A cell is 0.1 m, the south-west
/// corner lies at (1, 2).
GridSlice slice_of(const std::vector<std::string>& rows) {
  const int width = static_cast<int>(rows[0].size()), height = static_cast<int>(rows.size());
  GridSlice slice;
  slice.cell_m = 0.1f;
  slice.origin = {1.f, 2.f};
  slice.occupancy = Image<std::uint8_t>(width, height);
  slice.distance_m = Image<float>(width, height);
  std::vector<std::uint8_t> obstacle;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const char c = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
      slice.occupancy.at(x, y) = c == '#' ? 0 : c == '.' ? 254 : 205;
      obstacle.push_back(c == '#');
    }
  const auto squared = squared_distances(obstacle, {width, height, 1});
  for (std::size_t i = 0; i < squared.size(); ++i)
    slice.distance_m[i] = std::sqrt(squared[i]) * slice.cell_m;
  return slice;
}

const std::vector<std::string> kTwoRooms = {"#########",  //
                                            "#...#...#",  //
                                            "#...#...#",  //
                                            "#.......#",  //
                                            "#...#...#",  //
                                            "#########"};

TEST(GroundWays, LeadThroughTheDoor) {
  const PassableCells cells(slice_of(kTwoRooms), 0.05f);
  const GroundWays ways(cells, {1, 1});
  ASSERT_TRUE(ways.reaches({7, 1}));
  EXPECT_NEAR(ways.length_m({7, 1}), 0.1f * (2 + 4 * std::sqrt(2.f)), 1e-5f);
  const auto way = ways.way_to({7, 1});
  EXPECT_TRUE(way.front().isApprox(Eigen::Vector2f(1.15f, 2.45f)));
  EXPECT_TRUE(way.back().isApprox(Eigen::Vector2f(1.75f, 2.45f)));
  EXPECT_LE(way.size(), 5u);
  float length = 0;
  for (std::size_t i = 1; i < way.size(); ++i) length += (way[i] - way[i - 1]).norm();
  EXPECT_LE(length, ways.length_m({7, 1}) + 1e-5f);
  for (std::size_t i = 1; i < way.size(); ++i)  // never through the wall
    for (float t = 0; t <= 1; t += 0.05f) {
      const Eigen::Vector2f at = way[i - 1] + t * (way[i] - way[i - 1]);
      if (at.x() > 1.401f && at.x() < 1.499f) {
        EXPECT_NEAR(at.y(), 2.25f, 0.051f);
      }
    }
}

TEST(GroundWays, AWideRobotStaysInItsRoom) {
  const PassableCells cells(slice_of(kTwoRooms), 0.15f);
  ASSERT_TRUE(cells.at({2, 2}));
  EXPECT_FALSE(cells.at({4, 3}));
  EXPECT_FALSE(GroundWays(cells, {2, 2}).reaches({6, 2}));
  EXPECT_TRUE(cells.in_largest_part());
  EXPECT_FALSE(PassableCells(slice_of(kTwoRooms), 0.5f).in_largest_part());
}

TEST(GroundWays, UnknownIsNotFree) {
  const PassableCells cells(slice_of({"...?..."}), 0.05f);
  EXPECT_FALSE(GroundWays(cells, {0, 0}).reaches({6, 0}));
}

TEST(GroundWays, ThePlaceOfACellIsFoundAgain) {
  const PassableCells cells(slice_of(kTwoRooms), 0.05f);
  EXPECT_EQ(cells.nearest(cells.place_of({6, 2}), 0.01f), Eigen::Vector2i(6, 2));
  EXPECT_EQ(cells.nearest({1.44f, 2.45f}, 0.12f), Eigen::Vector2i(3, 1));  // in the wall
  EXPECT_FALSE(cells.nearest({9.f, 9.f}, 0.5f));
}

}  // namespace
}  // namespace ovimap
