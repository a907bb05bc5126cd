// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scores/box_scores.h"

#include <gtest/gtest.h>

#include <vector>

namespace ovimap {
namespace {

using Eigen::Vector3f;

const std::vector<Vector3f> kCorners = {{0, 0, 0}, {1, 1, 1}, {5, 0, 0}, {6, 1, 1}, {9, 9, 9}};

TEST(BoxScores, AreOfThingsThatWereFound) {
  const LabelledScene scene{{1, 1, 2, 2, 0}, {7, 7, 8, 8, 8}, {}};
  BoxScores scores = box_scores(
      kCorners, scene,
      {{7, {Vector3f(0, 0, 0), Vector3f(1, 1, 2)}}, {8, {Vector3f(5, 0, 0), Vector3f(9, 9, 9)}}});
  EXPECT_EQ(scores.things, 2);
  EXPECT_NEAR(scores.mean_iou(), (0.5 + 1. / 324) / 2, 1e-6);
  EXPECT_EQ(scores.under_quarter, 1) << "the one that reaches to a speck";
  scores += scores;
  EXPECT_EQ(scores.things, 4);
  EXPECT_NEAR(scores.mean_iou(), (0.5 + 1. / 324) / 2, 1e-6);
}

TEST(BoxScores, LeaveOutWhatIsNotFoundOrHasNoBox) {
  const LabelledScene scene{{1, 1, 2, 2, 0}, {0, 0, 8, 8, 0}, {}};
  EXPECT_EQ(box_scores(kCorners, scene, {}).things, 0);
  EXPECT_EQ(box_scores(kCorners, scene, {}).mean_iou(), 0.);
}

}  // namespace
}  // namespace ovimap
