// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scenes/overlap.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(CountOverlaps, CountsByHand) {
  const std::vector<std::int32_t> truth = {7, 7, 7, 2, 2, 0, -1, 7};
  const std::vector<std::uint32_t> predicted = {1, 1, 9, 9, 0, 9, 9, 0};
  const InstanceOverlaps table = count_overlaps(truth, predicted, Background::kNotPositive);
  ASSERT_EQ(table.truth.size(), 2u);
  EXPECT_EQ(table.truth[0].id, 2);
  EXPECT_EQ(table.truth[0].vertices, 2);
  EXPECT_EQ(table.truth[1].id, 7);
  EXPECT_EQ(table.truth[1].vertices, 4);
  ASSERT_EQ(table.predicted.size(), 2u);
  EXPECT_EQ(table.predicted[0].vertices, 2);
  EXPECT_EQ(table.predicted[1].vertices, 4);
  EXPECT_EQ(table.unlabelled, (std::vector<std::int64_t>{0, 2}));
  ASSERT_EQ(table.of_predicted(0).size(), 1u);
  EXPECT_EQ(table.of_predicted(0)[0].iou(), 0.5);  // 2 shared, 4 + 2 - 2 united
  ASSERT_EQ(table.of_predicted(1).size(), 2u);
  EXPECT_EQ(table.of_predicted(1)[0].iou(), 0.2);        // with 2: 1 of 2 + 4 - 1
  EXPECT_EQ(table.of_predicted(1)[1].iou(), 1.0 / 7.0);  // with 7: 1 of 4 + 4 - 1
}

TEST(CountOverlaps, TheLowestIdMayBeTheBackground) {
  const std::vector<std::int32_t> truth = {3, 3, 4, 5, 5};
  const std::vector<std::uint32_t> predicted = {1, 1, 1, 2, 2};
  const InstanceOverlaps table = count_overlaps(truth, predicted, Background::kLowestId);
  ASSERT_EQ(table.truth.size(), 2u);
  EXPECT_EQ(table.truth[0].id, 4);
  EXPECT_EQ(table.predicted[0].vertices, 3);  // those on the dropped instance still count
  EXPECT_EQ(table.unlabelled, (std::vector<std::int64_t>{2, 0}));
}

TEST(CountOverlaps, LargeIdsStayApart) {
  const std::vector<std::int32_t> truth = {2147483647, 1};
  const std::vector<std::uint32_t> predicted = {4294967295u, 1};
  const InstanceOverlaps table = count_overlaps(truth, predicted, Background::kNotPositive);
  EXPECT_EQ(table.predicted[1].id, 4294967295);
  EXPECT_EQ(table.overlaps.size(), 2u);
  EXPECT_EQ(table.overlaps[1].iou(), 1.0);
}

TEST(CountOverlaps, NothingGivesNothing) {
  const InstanceOverlaps table = count_overlaps({}, {}, Background::kLowestId);
  EXPECT_TRUE(table.truth.empty());
  EXPECT_TRUE(table.predicted.empty());
  EXPECT_TRUE(table.overlaps.empty());
}

TEST(InstanceOverlap, ReachesAThresholdExactly) {
  EXPECT_TRUE((InstanceOverlap{0, 0, 19, 20}.reaches(95)));
  EXPECT_FALSE((InstanceOverlap{0, 0, 1899, 2000}.reaches(95)));
  EXPECT_TRUE((InstanceOverlap{0, 0, 7, 10}.reaches(70)));
}

}  // namespace
}  // namespace ovimap
