// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/super_point_merging.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

std::vector<SegmentAssociation> spanning(std::vector<Label> labels) {
  return {{labels[0], false, labels}};
}
std::vector<SegmentAssociation> apart(Label a, Label b) {
  return {{a, false, {}}, {b, false, {}}};
}

LabelForest forest_of(int labels) {
  LabelForest forest;
  for (int i = 0; i < labels; ++i) forest.create();
  return forest;
}

TEST(SuperPointMerging, MergesOnceTheCountExceedsTheThreshold) {
  SuperPointMerging merging({.merge_min_count = 3});
  LabelForest forest = forest_of(5);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(merging.observe(spanning({2, 4}), forest).empty());
  const auto merges = merging.observe(spanning({2, 4}), forest);
  ASSERT_EQ(merges.size(), 1u);
  EXPECT_EQ(merges[0].keep, 2u);
  EXPECT_EQ(merges[0].drop, 4u);
  EXPECT_EQ(forest.root(4), 2u);
  EXPECT_TRUE(merging.counts().empty());
}

TEST(SuperPointMerging, FramesThatKeepThemApartOutweighTheMerge) {
  SuperPointMerging merging({.merge_min_count = 3, .merge_max_dissent = 1.f});
  LabelForest forest = forest_of(5);
  merging.observe(spanning({2, 4}), forest);
  for (int i = 0; i < 20; ++i) merging.observe(apart(2, 4), forest);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(merging.observe(spanning({2, 4}), forest).empty());
}

TEST(SuperPointMerging, ChainsOfPairsBecomeOne) {
  SuperPointMerging merging({.merge_min_count = 1});
  LabelForest forest = forest_of(5);
  merging.observe(spanning({1, 2, 3}), forest);
  EXPECT_EQ(merging.observe(spanning({1, 2, 3}), forest).size(), 2u);
  EXPECT_EQ(forest.root(3), 1u);
}

TEST(SuperPointMerging, CountsFollowTheSurvivor) {
  SuperPointMerging merging({.merge_min_count = 2});
  LabelForest forest = forest_of(5);
  merging.observe(spanning({3, 5}), forest);
  for (int i = 0; i < 3; ++i) merging.observe(spanning({2, 5}), forest);
  EXPECT_EQ(forest.root(5), 2u);
  EXPECT_EQ(merging.counts().at({2, 3}).joined, 1);
}

}  // namespace
}  // namespace ovimap
