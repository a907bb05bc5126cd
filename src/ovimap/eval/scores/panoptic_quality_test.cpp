// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scores/panoptic_quality.h"

#include <gtest/gtest.h>

#include "ovimap/eval/scenes/semantic_fixture.h"

namespace ovimap {
namespace {

using fixture::add;

constexpr std::int32_t kChair = 1, kWall = 2, kLamp = 3, kVoid = 0;
const SemanticClasses kClasses{3, {kWall}};

/// Two chairs, one of them found; two walls, three quarters found; void in between.
SemanticScene half_a_room() {
  SemanticScene scene;
  add(scene, 8, 1, kChair, 11), add(scene, 2, 1, kChair, 0);
  add(scene, 4, 2, kChair, 12), add(scene, 6, 2, kChair, 0);
  add(scene, 10, 3, kWall, 13), add(scene, 5, 4, kWall, 14), add(scene, 5, 4, kWall, 0);
  add(scene, 4, 0, kVoid, 11), add(scene, 2, 0, kVoid, 15);
  scene.predicted_classes = {{11, kChair}, {12, kChair}, {13, kWall}, {14, kWall}, {15, kChair}};
  return scene;
}

TEST(PanopticQuality, IsAsComputedByHand) {
  const SemanticScene scene = half_a_room();
  const std::vector<PanopticCounts> counts = panoptic_counts({&scene, 1}, kClasses);
  ASSERT_EQ(counts.size(), 3u);
  const PanopticCounts &chair = counts[0], &wall = counts[1];
  // 11 without its void vertices is 8 of 10; 12 (4 of 10) is wrong and its chair missed; 15 lies on
  // void alone and is no error.
  EXPECT_EQ(chair.right, 1);
  EXPECT_EQ(chair.wrong, 1);
  EXPECT_EQ(chair.missed, 1);
  EXPECT_DOUBLE_EQ(chair.segmentation_quality(), 0.8);
  EXPECT_DOUBLE_EQ(chair.recognition_quality(), 0.5);
  EXPECT_DOUBLE_EQ(chair.quality(), 0.4);
  // Walls are one segment: 15 of 20.
  EXPECT_EQ(wall.segments(), 1);
  EXPECT_DOUBLE_EQ(wall.quality(), 0.75);
  EXPECT_EQ(counts[2].segments(), 0);
  EXPECT_EQ(counts[2].quality(), 0);
}

TEST(PanopticQuality, AWrongClassIsWrongAndMissed) {
  SemanticScene scene = half_a_room();
  scene.predicted_classes[11] = kLamp;
  const std::vector<PanopticCounts> counts = panoptic_counts({&scene, 1}, kClasses);
  EXPECT_EQ(counts[0].missed, 2);
  EXPECT_EQ(counts[0].right, 0);
  EXPECT_EQ(counts[2].wrong, 1);
  EXPECT_EQ(counts[2].quality(), 0);
}

TEST(PanopticQuality, HalfIsNoMatch) {
  SemanticScene scene;
  add(scene, 5, 1, kChair, 11), add(scene, 5, 1, kChair, 12);
  scene.predicted_classes = {{11, kChair}, {12, kChair}};
  const std::vector<PanopticCounts> counts = panoptic_counts({&scene, 1}, kClasses);
  EXPECT_EQ(counts[0].wrong, 2);
  EXPECT_EQ(counts[0].missed, 1);
}

TEST(PanopticQuality, StuffWithoutInstanceCountsAndThingsWithoutAreVoid) {
  SemanticScene scene;
  add(scene, 9, 0, kWall, 11), add(scene, 9, 0, kChair, 12);
  scene.predicted_classes = {{11, kWall}, {12, kChair}};
  const std::vector<PanopticCounts> counts = panoptic_counts({&scene, 1}, kClasses);
  EXPECT_EQ(counts[1].quality(), 1);
  EXPECT_EQ(counts[0].segments(), 0);
}

TEST(PanopticQuality, ScenesAreSummed) {
  const std::vector<SemanticScene> scenes(3, half_a_room());
  const std::vector<PanopticCounts> counts = panoptic_counts(scenes, kClasses);
  EXPECT_EQ(counts[0].right, 3);
  EXPECT_EQ(counts[1].right, 3);
  EXPECT_DOUBLE_EQ(counts[0].quality(), 0.4);
}

}  // namespace
}  // namespace ovimap
