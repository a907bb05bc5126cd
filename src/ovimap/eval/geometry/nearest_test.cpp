// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/geometry/nearest.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"

namespace ovimap {
namespace {

using Points = std::vector<Eigen::Vector3f>;

std::optional<NearestPoints::Neighbor> brute_force(const Points& points,
                                                   const Eigen::Vector3f& query, float radius_m) {
  std::optional<NearestPoints::Neighbor> best;
  float best_squared = radius_m * radius_m;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float d = (points[i] - query).squaredNorm();
    if (best ? d < best_squared : d <= best_squared) {
      best_squared = d;
      best = NearestPoints::Neighbor{static_cast<std::uint32_t>(i), std::sqrt(d)};
    }
  }
  return best;
}

Points random_points(std::size_t count, unsigned seed, float extent_m) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> real(-extent_m, extent_m);
  Points points;
  for (std::size_t i = 0; i < count; ++i)
    points.emplace_back(real(random), real(random), real(random));
  return points;
}

TEST(NearestPoints, AgreesWithBruteForce) {
  for (const std::size_t count : {1, 2, 13, 200, 3000}) {
    const Points points = random_points(count, 3, 0.5f);
    const Points queries = random_points(300, 4, 0.6f);
    const NearestPoints tree(points);
    int found = 0;
    for (const float radius_m : {0.05f, 0.2f, 10.f})
      for (const Eigen::Vector3f& query : queries) {
        const auto expected = brute_force(points, query, radius_m);
        EXPECT_EQ(tree.find(query, radius_m), expected);
        found += expected.has_value();
      }
    EXPECT_GE(found, 300);  // the widest radius always finds one
    EXPECT_LT(found, 900);
  }
}

// On a lattice nearly every query has ties and many points share their coordinates.
TEST(NearestPoints, TheLowestIndexWinsTies) {
  Points points;
  for (int i = 0; i < 2000; ++i)
    points.emplace_back(static_cast<float>(i % 5), static_cast<float>(i / 5 % 5),
                        static_cast<float>(i / 25 % 4));
  const NearestPoints tree(points);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3f query(0.5f * static_cast<float>(i % 9),
                                0.5f * static_cast<float>(i / 9 % 9), 1.5f);
    EXPECT_EQ(tree.find(query, 2.f), brute_force(points, query, 2.f));
  }
}

TEST(NearestPoints, TheRadiusIsInclusive) {
  const NearestPoints tree(Points{{1, 0, 0}});
  EXPECT_EQ(tree.find({1.5f, 0, 0}, 0.5f), (NearestPoints::Neighbor{0, 0.5f}));
  EXPECT_EQ(tree.find({1.5f, 0, 0}, 0.499f), std::nullopt);
}

TEST(NearestPoints, FindsNothingAmongNothingOrForNoPlace) {
  EXPECT_EQ(NearestPoints(Points{}).find({0, 0, 0}, 1.f), std::nullopt);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(NearestPoints(random_points(100, 5, 1)).find({nan, 0, 0}, 1.f), std::nullopt);
}

TEST(NearestPoints, ManyQueriesGiveTheSameOnAnyThreadCount) {
  const Points points = random_points(4000, 6, 1), queries = random_points(4000, 7, 1);
  const NearestPoints tree(points);
  const auto with = [&](int threads) {
    ThreadLimit limit(threads);
    return tree.find_all(queries, 0.1f);
  };
  const auto one = with(1);
  EXPECT_EQ(one, with(2));
  EXPECT_EQ(one[17], brute_force(points, queries[17], 0.1f));
}

}  // namespace
}  // namespace ovimap
