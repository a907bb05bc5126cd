// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/views/sphere_grid.h"

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(SphereGrid, PutsKnownDirectionsIntoTheirBins) {
  const SphereGrid grid{180, 240};
  EXPECT_EQ(bin_of(grid, {0, 0, 1}) / 240, 0);     // the pole
  EXPECT_EQ(bin_of(grid, {0, 0, -1}) / 240, 179);  // theta = pi is clamped
  EXPECT_EQ(bin_of(grid, {1, 0, 0}), 90 * 240 + 120);
  EXPECT_EQ(bin_of(grid, {0, 5, 0}), 90 * 240 + 180);
  EXPECT_EQ(bin_of(grid, {-1, 0, 0}), 90 * 240 + 239);  // phi = pi is clamped
}

TEST(SphereGrid, HasNoBinForNoDirection) {
  const SphereGrid grid;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  EXPECT_EQ(bin_of(grid, {0, 0, 0}), -1);
  EXPECT_EQ(bin_of(grid, {nan, 0, 1}), -1);
  EXPECT_EQ(bin_of(grid, {0, infinite, 1}), -1);
  BinSet bins(grid.bins());
  const std::vector<float> x{0, nan, 0}, y{0, 0, infinite}, z{0, 1, 1};
  mark_directions(grid, {x, y, z}, bins);
  EXPECT_EQ(bins.count(), 0);
}

TEST(SphereGrid, FastBinsAreThePlainOnes) {
  const SphereGrid grid{180, 240};
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  int differing = 0;
  constexpr int kDirections = 20000;
  for (int i = 0; i < kDirections; ++i) {
    const Eigen::Vector3f direction(normal(random), normal(random), normal(random));
    BinSet bins(grid.bins());
    mark_directions(grid, {{&direction.x(), 1}, {&direction.y(), 1}, {&direction.z(), 1}}, bins);
    ASSERT_EQ(bins.count(), 1);
    if (bins.has(bin_of(grid, direction))) continue;
    ++differing;  // only at a boundary: turned a little, the plain version agrees
    bool near = false;
    for (const float dx : {-2e-6f, 0.f, 2e-6f})
      for (const float dy : {-2e-6f, 0.f, 2e-6f})
        for (const float dz : {-2e-6f, 0.f, 2e-6f})
          near |= bins.has(bin_of(grid, direction.normalized() + Eigen::Vector3f(dx, dy, dz)));
    EXPECT_TRUE(near) << direction.transpose();
  }
  EXPECT_LT(differing, kDirections / 1000);
}

TEST(SphereGrid, EveryBinIsReached) {
  const SphereGrid grid{6, 8};
  std::set<int> seen;
  std::mt19937 random(2);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 5000; ++i)
    seen.insert(bin_of(grid, {normal(random), normal(random), normal(random)}));
  EXPECT_EQ(seen.size(), 48u);
  EXPECT_EQ(*seen.begin(), 0);
  EXPECT_EQ(*seen.rbegin(), 47);
}

TEST(BinSet, CountsAndUnites) {
  BinSet a(130), b(130);
  for (const int bin : {0, 63, 64, 129}) a.set(bin);
  for (const int bin : {64, 100}) b.set(bin);
  EXPECT_EQ(a.count(), 4);
  EXPECT_EQ(a.count_outside(b), 3);
  EXPECT_EQ(b.count_outside(a), 1);
  a |= b;
  EXPECT_EQ(a.count(), 5);
  EXPECT_TRUE(a.has(100));
  EXPECT_FALSE(a.has(101));
  EXPECT_EQ(BinSet::from_words(a.words(), 130), a);
}

TEST(BinSet, TakesNoWordsOfAnotherGrid) {
  EXPECT_TRUE(BinSet::from_words({0, 0, 3}, 130).has_value());
  EXPECT_FALSE(BinSet::from_words({0, 0, 4}, 130).has_value()) << "bin 130";
  EXPECT_FALSE(BinSet::from_words({0, 0}, 130).has_value());
  EXPECT_FALSE(BinSet::from_words({0, 0, 0, 0}, 130).has_value());
  EXPECT_TRUE(BinSet::from_words({~std::uint64_t{0}}, 64).has_value());
  EXPECT_FALSE(BinSet::from_words({}, 64).has_value());
}

}  // namespace
}  // namespace ovimap
