// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/voxels/label_forest.h"

#include <gtest/gtest.h>

#include "ovimap/base/error.h"

namespace ovimap {
namespace {

TEST(LabelForest, LowestLabelSurvivesChainsOfMerges) {
  LabelForest forest;
  for (int i = 0; i < 5; ++i) forest.create();
  EXPECT_EQ(forest.merge(4, 5), 4u);
  EXPECT_EQ(forest.merge(5, 2), 2u);
  EXPECT_EQ(forest.root(4), 2u);
  EXPECT_EQ(forest.root(5), 2u);
  EXPECT_EQ(forest.root(3), 3u);
  EXPECT_EQ(forest.epoch(), 2u);
  EXPECT_EQ(forest.merge(4, 5), 2u) << "already one";
  EXPECT_EQ(forest.epoch(), 2u);
}

TEST(LabelForest, RoundTripsThroughItsRoots) {
  LabelForest forest;
  for (int i = 0; i < 4; ++i) forest.create();
  forest.merge(2, 4);
  const LabelForest copy = LabelForest::from_roots(forest.roots(), forest.epoch());
  EXPECT_EQ(copy.roots(), forest.roots());
}

TEST(LabelForest, RefusesCorruptRoots) {
  EXPECT_THROW(LabelForest::from_roots({}, 0), Error);
  EXPECT_THROW(LabelForest::from_roots({0, 2, 1}, 0), Error);
  EXPECT_THROW(LabelForest::from_roots({0, 9}, 0), Error);
}

}  // namespace
}  // namespace ovimap
