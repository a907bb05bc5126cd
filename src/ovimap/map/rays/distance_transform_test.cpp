// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/rays/distance_transform.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

/// Every cell against every obstacle.
std::vector<float> brute_force(const std::vector<std::uint8_t>& obstacle,
                               const Eigen::Vector3i& size) {
  const auto cell = [&](std::size_t i) {
    const auto index = static_cast<int>(i);
    return Eigen::Vector3i(index % size.x(), index / size.x() % size.y(),
                           index / (size.x() * size.y()));
  };
  std::vector<float> distances(obstacle.size(), kNoObstacle);
  for (std::size_t i = 0; i < obstacle.size(); ++i)
    for (std::size_t j = 0; j < obstacle.size(); ++j)
      if (obstacle[j] != 0)
        distances[i] =
            std::min(distances[i], static_cast<float>((cell(i) - cell(j)).squaredNorm()));
  return distances;
}

TEST(DistanceTransform, IsExact) {
  std::mt19937 random(5);
  for (const Eigen::Vector3i& size :
       {Eigen::Vector3i(17, 1, 1), Eigen::Vector3i(1, 13, 1), Eigen::Vector3i(31, 23, 1),
        Eigen::Vector3i(9, 14, 11), Eigen::Vector3i(1, 1, 1), Eigen::Vector3i(130, 70, 1)})
    for (const unsigned one_in : {2u, 20u, 400u, 100000u}) {
      std::vector<std::uint8_t> obstacle(static_cast<std::size_t>(size.prod()));
      for (std::uint8_t& cell : obstacle) cell = random() % one_in == 0;
      EXPECT_EQ(squared_distances(obstacle, size), brute_force(obstacle, size))
          << size.transpose() << ", one in " << one_in;
    }
}

TEST(DistanceTransform, KnowsWhenThereIsNoObstacle) {
  const std::vector<std::uint8_t> nothing(60, 0);
  for (const float distance : squared_distances(nothing, {5, 4, 3}))
    EXPECT_EQ(distance, kNoObstacle);
}

TEST(DistanceTransform, MeasuresFarExactly) {
  std::vector<std::uint8_t> obstacle(3000, 0);
  obstacle[0] = 1;
  const auto distances = squared_distances(obstacle, {3000, 1, 1});
  EXPECT_EQ(distances[2999], 2999.f * 2999.f);
}

}  // namespace
}  // namespace ovimap
