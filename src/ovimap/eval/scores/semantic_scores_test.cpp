// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scores/semantic_scores.h"

#include <gtest/gtest.h>

#include "ovimap/eval/scenes/semantic_fixture.h"

namespace ovimap {
namespace {

using fixture::add;

constexpr std::int32_t kChair = 1, kTable = 2, kWall = 3, kLamp = 4;
const SemanticClasses kClasses{4, {kWall}};

/// Two chairs, a table and a wall; the second chair is taken for a table.
SemanticScene small_room() {
  SemanticScene scene;
  add(scene, 10, 0, 0, 24);  // nothing is known there
  add(scene, 80, 5, kChair, 21), add(scene, 20, 5, kChair, 0);
  add(scene, 90, 6, kChair, 22), add(scene, 10, 6, kChair, 23);
  add(scene, 150, 7, kTable, 23), add(scene, 50, 7, kTable, 24);
  add(scene, 500, 8, kWall, 24), add(scene, 100, 8, kWall, 21);
  scene.predicted_classes = {{21, kChair}, {22, kTable}, {23, kTable}, {24, kWall}};
  return scene;
}

std::vector<ClassScores> standard(const SemanticScene& scene) {
  return standard_class_scores({&scene, 1}, kClasses);
}

std::vector<ClassScores> reference(const SemanticScene& scene) {
  return reference_class_scores({&scene, 1}, kClasses);
}

TEST(SemanticScores, ConfusionIsAsComputedByHand) {
  const SemanticScene scene = small_room();
  for (const auto& scores : {standard(scene), reference(scene)}) {
    ASSERT_EQ(scores.size(), 4u);
    EXPECT_EQ(scores[0].class_number, kChair);
    EXPECT_EQ(scores[0].truth_vertices, 200);
    EXPECT_EQ(scores[0].predicted_vertices, 180);
    EXPECT_DOUBLE_EQ(*scores[0].iou, 80.0 / (200 + 180 - 80));
    EXPECT_DOUBLE_EQ(*scores[0].accuracy, 80.0 / 200);
    EXPECT_DOUBLE_EQ(*scores[1].iou, 150.0 / (200 + 250 - 150));
    EXPECT_DOUBLE_EQ(*scores[1].accuracy, 150.0 / 200);
    EXPECT_DOUBLE_EQ(*scores[2].iou, 500.0 / (600 + 550 - 500));
    EXPECT_DOUBLE_EQ(*scores[2].accuracy, 500.0 / 600);
    EXPECT_FALSE(scores[3].iou.has_value());
    EXPECT_FALSE(scores[3].accuracy.has_value());
    const SemanticScores means = mean_scores(scores);
    EXPECT_EQ(means.classes, 3);
    EXPECT_DOUBLE_EQ(means.miou, (80.0 / 300 + 150.0 / 300 + 500.0 / 650) / 3);
    EXPECT_DOUBLE_EQ(means.macc, (80.0 / 200 + 150.0 / 200 + 500.0 / 600) / 3);
    EXPECT_DOUBLE_EQ(means.fwiou,
                     (200 * 80.0 / 300 + 200 * 150.0 / 300 + 600 * 500.0 / 650) / 1000);
  }
}

TEST(SemanticScores, StandardPrecisionIsAsComputedByHand) {
  const std::vector<ClassScores> scores = standard(small_room());
  // Chair: 21 (80 of 100 + 180 - 80) reaches 0.25 and 0.40; the other chair is missed.
  EXPECT_DOUBLE_EQ(*scores[0].ap25, 0.5);
  EXPECT_DOUBLE_EQ(*scores[0].ap50, 0);
  // Table: 23 (150 of 210) right, then 22 wrong; IoU 0.714 reaches 0.50 ... 0.70.
  EXPECT_DOUBLE_EQ(*scores[1].ap50, 1);
  EXPECT_DOUBLE_EQ(*scores[1].ap75, 0);
  EXPECT_DOUBLE_EQ(*scores[1].ap, 0.5);
  // Wall: 24 (500 of 660) reaches 0.75.
  EXPECT_DOUBLE_EQ(*scores[2].ap75, 1);
  EXPECT_DOUBLE_EQ(*scores[2].ap, 0.6);
  EXPECT_FALSE(scores[3].ap.has_value());
  const SemanticScores means = mean_scores(scores);
  EXPECT_EQ(means.instance_classes, 3);
  EXPECT_DOUBLE_EQ(means.ap25, (0.5 + 1 + 1) / 3);
  EXPECT_DOUBLE_EQ(means.ap50, 2.0 / 3);
  EXPECT_DOUBLE_EQ(means.ap75, 1.0 / 3);
  EXPECT_DOUBLE_EQ(means.ap, (0 + 0.5 + 0.6) / 3);
}

TEST(SemanticScores, StandardCarriesPanopticQuality) {
  const std::vector<ClassScores> scores = standard(small_room());
  EXPECT_DOUBLE_EQ(*scores[0].pq, 0);
  // Table: one right (150 of 210), one wrong. Wall: 500 of 650, its 10 vertices on void left out.
  EXPECT_DOUBLE_EQ(*scores[1].sq, 150.0 / 210);
  EXPECT_DOUBLE_EQ(*scores[1].rq, 1 / 1.5);
  EXPECT_DOUBLE_EQ(*scores[2].pq, 500.0 / 650);
  EXPECT_FALSE(scores[3].pq.has_value());
  EXPECT_DOUBLE_EQ(mean_scores(scores).pq, (0 + 150.0 / 210 / 1.5 + 500.0 / 650) / 3);
}

TEST(SemanticScores, ReferencePrecisionIsAsComputedByHand) {
  const std::vector<ClassScores> scores = reference(small_room());
  // Chair: 21 has IoU 0.44, so at 0.25 one of two is found: points (1/2, 1), (0, 1).
  EXPECT_DOUBLE_EQ(*scores[0].ap25, 0.5);
  // At 0.50 it reaches nothing, but 100 of its 180 vertices lie on stuff: ignored.
  EXPECT_DOUBLE_EQ(*scores[0].ap50, 0);
  // Table: 23 is right with confidence 1; 22 has 90 vertices and does not count.
  EXPECT_DOUBLE_EQ(*scores[1].ap50, 1);
  EXPECT_DOUBLE_EQ(*scores[1].ap75, 0);
  EXPECT_DOUBLE_EQ(*scores[1].ap, 5.0 / 9);  // 0.50 ... 0.70 of 0.50 ... 0.90
  EXPECT_FALSE(scores[2].ap.has_value());    // stuff
  EXPECT_FALSE(scores[1].pq.has_value());
  EXPECT_EQ(mean_scores(scores).instance_classes, 2);
  EXPECT_DOUBLE_EQ(mean_scores(scores).ap, 5.0 / 18);
}

TEST(SemanticScores, ReferenceRanksBySizeWithinAScene) {
  SemanticScene scene;
  add(scene, 1, 0, 0, 0);
  add(scene, 300, 1, kChair, 11);
  add(scene, 150, 2, kChair, 12), add(scene, 350, 2, kChair, 0);
  add(scene, 200, 3, kTable, 13);
  scene.predicted_classes = {{11, kChair}, {12, kChair}, {13, kChair}};
  // At 0.25: 11 right (1), 13 wrong (2/3), 12 right (1/2): points (1, 2/3), (1/2, 1/2), (1/2, 1),
  // (0, 1).
  EXPECT_DOUBLE_EQ(*reference(scene)[0].ap25, 2.0 / 3 / 4 + 0.5 / 4 + 0.25 + 0.25);
  scene.instances.confidence = {{11, 0.1f}, {12, 0.2f}, {13, 0.9f}};  // not looked at
  EXPECT_DOUBLE_EQ(*reference(scene)[0].ap25, 2.0 / 3 / 4 + 0.5 / 4 + 0.25 + 0.25);
  // The standard protocol ranks by them: 13 wrong, 12 right at 1/2, 11 right at 2/3.
  EXPECT_DOUBLE_EQ(*standard(scene)[0].ap25, 2.0 / 3);
}

TEST(SemanticScores, ReferenceDropsTheLowestTruthId) {
  SemanticScene scene;
  add(scene, 200, 3, kChair, 11), add(scene, 200, 4, kTable, 12);
  scene.predicted_classes = {{11, kChair}, {12, kTable}};
  EXPECT_FALSE(reference(scene)[0].ap.has_value());
  EXPECT_EQ(*reference(scene)[1].ap, 1);
  EXPECT_EQ(*reference(scene)[0].iou, 1);  // vertices still count
  EXPECT_EQ(*standard(scene)[0].ap, 1);
}

TEST(SemanticScores, AnInstanceOfTwoClassesTakesTheMajorityOrTheHighest) {
  SemanticScene scene;
  add(scene, 1, 0, 0, 0);
  add(scene, 200, 1, kChair, 11), add(scene, 5, 1, kTable, 11);
  scene.predicted_classes = {{11, kChair}};
  EXPECT_EQ(*standard(scene)[0].ap, 1);
  EXPECT_FALSE(standard(scene)[1].ap.has_value());
  EXPECT_FALSE(reference(scene)[0].ap.has_value());
  EXPECT_EQ(*reference(scene)[1].ap, 0);
}

TEST(SemanticScores, VoidTruthExcusesAndUnclassedPredictionsMiss) {
  SemanticScene scene;
  add(scene, 300, 1, 99, 11);  // a class outside of 1..K
  add(scene, 200, 2, kChair, 12), add(scene, 200, 3, kLamp, 13);
  scene.predicted_classes = {{11, kChair}, {12, kChair}};
  const std::vector<ClassScores> scores = standard(scene);
  EXPECT_EQ(*scores[0].ap, 1);   // 11 is larger and would rank first, but lies on void
  EXPECT_EQ(*scores[0].iou, 1);  // nor does it count as vertices
  EXPECT_EQ(*scores[3].iou, 0);
  EXPECT_EQ(*scores[3].ap, 0);
  EXPECT_EQ(mean_scores(scores).miou, 0.5);
}

TEST(SemanticScores, GroupsAreMeansOverTheirClasses) {
  const std::vector<ClassScores> scores = standard(small_room());
  const std::vector<std::int32_t> group = {kTable, kLamp};
  const SemanticScores means = mean_scores(scores, group);
  EXPECT_EQ(means.classes, 1);
  EXPECT_DOUBLE_EQ(means.miou, 0.5);
  EXPECT_DOUBLE_EQ(means.ap50, 1);
  EXPECT_DOUBLE_EQ(means.fwiou, 0.5);
  EXPECT_EQ(mean_scores(scores, {}).miou, 0);
}

TEST(SemanticScores, DroppedInstancesLeaveTheirVerticesUnlabelled) {
  SemanticScene scene = small_room();
  const std::vector<std::uint32_t> dropped = {24, 21};
  scene.instances = without_instances(scene.instances, dropped);
  EXPECT_EQ(*standard(scene)[2].iou, 0);
  EXPECT_EQ(std::count(scene.instances.predicted.begin(), scene.instances.predicted.end(), 24u), 0);
  EXPECT_EQ(std::count(scene.instances.predicted.begin(), scene.instances.predicted.end(), 22u),
            90);
}

void expect_same(const std::vector<ClassScores>& a, const std::vector<ClassScores>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t c = 0; c < a.size(); ++c)
    for (const auto figure : {&ClassScores::iou, &ClassScores::accuracy, &ClassScores::ap25,
                              &ClassScores::ap50, &ClassScores::ap, &ClassScores::pq}) {
      ASSERT_EQ((a[c].*figure).has_value(), (b[c].*figure).has_value());
      EXPECT_NEAR((a[c].*figure).value_or(-1), (b[c].*figure).value_or(-1), 1e-12);
    }
}

/// Other ids in the same order (the reference protocol visits and drops by order).
SemanticScene renamed(const SemanticScene& scene) {
  SemanticScene result = scene;
  for (std::int32_t& id : result.instances.truth) id = id == 0 ? 0 : 7 * id + 3;
  for (std::uint32_t& id : result.instances.predicted) id = id == 0 ? 0 : 11 * id + 1000;
  result.predicted_classes.clear(), result.instances.confidence.clear();
  for (const auto& [id, number] : scene.predicted_classes)
    result.predicted_classes[11 * id + 1000] = number;
  for (const auto& [id, sure] : scene.instances.confidence)
    result.instances.confidence[11 * id + 1000] = sure;
  return result;
}

/// Ids in the opposite order.
SemanticScene reversed(const SemanticScene& scene) {
  SemanticScene result = scene;
  for (std::int32_t& id : result.instances.truth) id = id == 0 ? 0 : 100 - id;
  for (std::uint32_t& id : result.instances.predicted) id = id == 0 ? 0 : 100 - id;
  result.predicted_classes.clear(), result.instances.confidence.clear();
  for (const auto& [id, number] : scene.predicted_classes)
    result.predicted_classes[100 - id] = number;
  for (const auto& [id, sure] : scene.instances.confidence)
    result.instances.confidence[100 - id] = sure;
  return result;
}

TEST(SemanticScores, NamesAndOrdersDoNotMatter) {
  std::vector<SemanticScene> scenes, others, backwards;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    scenes.push_back(fixture::random_semantic_scene(seed));
    others.push_back(fixture::shuffled(renamed(scenes.back()), seed));
    backwards.push_back(reversed(scenes.back()));
  }
  std::reverse(others.begin(), others.end());
  const std::vector<ClassScores> plain = standard_class_scores(scenes, kClasses);
  EXPECT_GT(mean_scores(plain).ap50, 0);
  EXPECT_LT(mean_scores(plain).ap50, 1);
  expect_same(plain, standard_class_scores(others, kClasses));
  expect_same(plain, standard_class_scores(backwards, kClasses));
  const std::vector<ClassScores> as_released = reference_class_scores(scenes, kClasses);
  EXPECT_GT(mean_scores(as_released).ap50, 0);
  expect_same(as_released, reference_class_scores(others, kClasses));
}

}  // namespace
}  // namespace ovimap
