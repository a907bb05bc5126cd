// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/thing_cells.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ovimap {
namespace {

constexpr int kRows = 6, kColumns = 8, kCellPx = 5, kWidth = 40, kHeight = 30;

/// Maps on which nothing is seen yet.
class Drawn {
 public:
  Drawn() {
    maps_.rows = kRows;
    maps_.columns = kColumns;
    maps_.values.assign(FinderMaps::kMaps * kRows * kColumns, 0.f);
    maps_.image_from_cell = {kCellPx, kCellPx};
    for (int y = 0; y < kRows; ++y)
      for (int x = 0; x < kColumns; ++x) set(0, x, y, -10);
  }
  /// A thing that reaches so many cells to all sides and fills half its box.
  Drawn& thing(int x, int y, float depth_logit, float reach_cells) {
    set(0, x, y, depth_logit);
    for (int side = 1; side <= 4; ++side) set(side, x, y, std::log(reach_cells));
    return *this;
  }
  std::vector<Thing> things(const FinderConfig& config = {}) const {
    return things_in(cells(), config);
  }
  ThingCells cells() const { return {maps_, kWidth, kHeight}; }

 private:
  void set(int map, int x, int y, float value) {
    maps_.values[static_cast<std::size_t>((map * kRows + y) * kColumns + x)] = value;
  }
  FinderMaps maps_;
};

TEST(ThingsIn, APeakIsAThingWithItsBox) {
  const auto things = Drawn().thing(3, 2, 1, 2).things();
  ASSERT_EQ(things.size(), 1u);
  EXPECT_EQ(things[0].prompt.interior_px, Eigen::Vector2f(17, 12));
  EXPECT_TRUE(things[0].prompt.extent_px.min().isApprox(Eigen::Vector2f(7, 2), 1e-5f));
  EXPECT_TRUE(things[0].prompt.extent_px.max().isApprox(Eigen::Vector2f(27, 22), 1e-5f));
  EXPECT_NEAR(things[0].prompt.area_px, 200, 1);
  EXPECT_TRUE(things[0].prompt.known);
}

TEST(ThingsIn, BoxesEndAtTheImage) {
  const auto things = Drawn().thing(7, 5, 1, 4).things();
  ASSERT_EQ(things.size(), 1u);
  EXPECT_EQ(things[0].prompt.extent_px.max(), Eigen::Vector2f(kWidth - 1, kHeight - 1));
}

TEST(ThingsIn, TheSurestComeFirstAndNoMoreThanAsked) {
  Drawn drawn;
  drawn.thing(1, 1, 0.5f, 1).thing(4, 4, 3, 1).thing(6, 1, 2, 1);
  const auto all = drawn.things();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].prompt.interior_px, Eigen::Vector2f(22, 22));
  EXPECT_EQ(all[1].prompt.interior_px, Eigen::Vector2f(32, 7));
  EXPECT_EQ(drawn.things({.max_prompts = 2}).size(), 2u);
  EXPECT_EQ(drawn.things({.min_depth = 0.7f}).size(), 2u);
}

TEST(ThingsIn, OfTwoWithOneBoxTheSurerCounts) {
  Drawn drawn;
  drawn.thing(2, 2, 2, 20).thing(5, 3, 1, 20);  // both boxes are the image
  const auto things = drawn.things();
  ASSERT_EQ(things.size(), 1u);
  EXPECT_EQ(things[0].prompt.interior_px, Eigen::Vector2f(12, 12));
}

TEST(ThingsIn, AbsurdDistancesAreBounded) {
  const auto things = Drawn().thing(2, 2, 2, 1e30f).things();
  ASSERT_EQ(things.size(), 1u);
  EXPECT_TRUE(things[0].prompt.extent_px.sizes().allFinite());
}

TEST(ThingCells, CellsAgreeWithTheBoxTheySee) {
  Drawn drawn;
  drawn.thing(0, 0, 1, 0.5f).thing(1, 1, 1, 0.5f);  // each sees its own cell
  const std::vector<Eigen::Vector2i> chosen = {{0, 0}, {1, 1}};
  const Eigen::AlignedBox2f first(Eigen::Vector2f(0, 0), Eigen::Vector2f(4.5f, 4.5f));
  EXPECT_NEAR(drawn.cells().agreement({chosen.data(), 1}, first), 1, 1e-3f);
  EXPECT_NEAR(drawn.cells().agreement(chosen, first), 0.5f, 0.02f);
}

TEST(ThingCells, DeeperCellsCountMore) {
  Drawn drawn;
  drawn.thing(0, 0, 5, 0.5f).thing(1, 1, -5, 0.5f);
  const std::vector<Eigen::Vector2i> chosen = {{0, 0}, {1, 1}};
  const Eigen::AlignedBox2f first(Eigen::Vector2f(0, 0), Eigen::Vector2f(4.5f, 4.5f));
  EXPECT_GT(drawn.cells().agreement(chosen, first), 0.98f);
}

TEST(ThingCells, NoCellsAgreeWithNothing) {
  const Eigen::AlignedBox2f box(Eigen::Vector2f(0, 0), Eigen::Vector2f(5, 5));
  EXPECT_EQ(Drawn().cells().agreement({}, box), 0);
}

}  // namespace
}  // namespace ovimap
