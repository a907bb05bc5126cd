// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/shapes/random.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(Random, GivesTheSameNumbersOnEveryMachine) {
  // The published first outputs of SplitMix64 for seed 1234567.
  Random random(1234567);
  EXPECT_EQ(random.bits(), 6457827717110365317ull);
  EXPECT_EQ(random.bits(), 3203168211198807973ull);
  EXPECT_EQ(random.bits(), 9817491932198370423ull);
}

TEST(Random, UniformAndNormalHaveTheirMoments) {
  Random random(5);
  double sum = 0, normal_sum = 0, normal_square = 0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    const float value = random.uniform(2, 4), normal = random.normal();
    ASSERT_GE(value, 2);
    ASSERT_LT(value, 4);
    sum += value;
    normal_sum += normal;
    normal_square += normal * normal;
  }
  EXPECT_NEAR(sum / kCount, 3, 0.02);
  EXPECT_NEAR(normal_sum / kCount, 0, 0.03);
  EXPECT_NEAR(normal_square / kCount, 1, 0.04);
}

TEST(Random, StreamsAndSeedsDiffer) {
  EXPECT_NE(Random(1, 1).bits(), Random(1, 2).bits());
  EXPECT_NE(Random(1, 1).bits(), Random(2, 1).bits());
  EXPECT_EQ(Random(7, 3).bits(), Random(7, 3).bits());
}

TEST(Random, ShuffleKeepsAllItems) {
  std::vector<int> items(50);
  std::iota(items.begin(), items.end(), 0);
  std::vector<int> shuffled = items;
  Random(3).shuffle(shuffled);
  EXPECT_NE(shuffled, items);
  std::sort(shuffled.begin(), shuffled.end());
  EXPECT_EQ(shuffled, items);
}

}  // namespace
}  // namespace ovimap
