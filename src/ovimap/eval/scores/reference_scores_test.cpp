// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scores/reference_scores.h"

#include <gtest/gtest.h>

#include "ovimap/base/config.h"

namespace ovimap {
namespace {

void add(LabelledScene& scene, int count, std::int32_t truth, std::uint32_t predicted) {
  scene.truth.insert(scene.truth.end(), static_cast<std::size_t>(count), truth);
  scene.predicted.insert(scene.predicted.end(), static_cast<std::size_t>(count), predicted);
}

/// Two counted things (20 and 40 vertices), a dropped one (id 1), a tiny one (5 vertices).
LabelledScene four_things() {
  LabelledScene scene;
  add(scene, 30, 1, 11);                         // perfect, yet dropped
  add(scene, 10, 2, 12), add(scene, 10, 2, 13);  // two halves of one thing
  add(scene, 40, 3, 14), add(scene, 10, 1, 14);  // spills onto the dropped one
  add(scene, 5, 4, 15);                          // both too small to count
  return scene;
}

ReferenceScores reference_scores(const LabelledScene& scene,
                                 const ReferenceProtocolConfig& config = {}) {
  return reference_summary({&scene, 1}, config).pooled;
}

TEST(ReferenceScores, AreAsComputedByHand) {
  const ReferenceScores scores = reference_scores(four_things());
  EXPECT_EQ(scores.truth_instances, 2);
  EXPECT_EQ(scores.predicted_instances, 4);  // 11, 12, 13 and 14
  EXPECT_DOUBLE_EQ(scores.miou, (0.5 + 0.8) / 2);
  EXPECT_DOUBLE_EQ(scores.wiou, (20 * 0.5 + 40 * 0.8) / 60);
  // Not one-to-one: both halves are right at 0.25 and at 0.50; 11 only touches what was dropped.
  EXPECT_DOUBLE_EQ(scores.ap25, 3.0 / 4);
  EXPECT_DOUBLE_EQ(scores.recall25, 3.0 / 2);
  EXPECT_DOUBLE_EQ(scores.ap50, 3.0 / 4);
  EXPECT_DOUBLE_EQ(scores.ap75, 1.0 / 4);
  EXPECT_DOUBLE_EQ(scores.recall75, 1.0 / 2);
}

TEST(ReferenceScores, TheSmallestSizeIsASetting) {
  ReferenceProtocolConfig config;
  ConfigFields fields;
  list_fields(config, fields);
  fields.set("min_vertices", "5");
  EXPECT_EQ(reference_scores(four_things(), config).truth_instances, 3);
  fields.set("min_vertices", "21");
  EXPECT_EQ(reference_scores(four_things(), config).truth_instances, 1);
}

TEST(ReferenceScores, TheLowestIdGoesEvenWhenItIsABackgroundId) {
  LabelledScene scene = four_things();
  add(scene, 1, 0, 0);
  EXPECT_EQ(reference_scores(scene).truth_instances, 3);  // now id 1 stays
  add(scene, 1, -1, 0);
  add(scene, 20, 0, 16);
  EXPECT_EQ(reference_scores(scene).truth_instances, 4);  // as released: 0 counts when -1 is there
}

TEST(ReferenceScores, PerfectIsOneAndNothingIsZero) {
  LabelledScene perfect, nothing;
  add(perfect, 3, 0, 0), add(perfect, 30, 1, 8), add(perfect, 20, 2, 9);
  add(nothing, 3, 0, 0), add(nothing, 30, 1, 0);
  const auto figures = [](const ReferenceScores& s) {
    return std::vector<double>{s.miou, s.wiou,     s.ap25,     s.ap50,
                               s.ap75, s.recall25, s.recall50, s.recall75};
  };
  EXPECT_EQ(figures(reference_scores(perfect)), std::vector<double>(8, 1));
  EXPECT_EQ(figures(reference_scores(nothing)), std::vector<double>(8, 0));
  EXPECT_EQ(figures(reference_scores(LabelledScene{})), std::vector<double>(8, 0));
}

TEST(ReferenceSummary, AveragesScenesAndPoolsSums) {
  LabelledScene one, empty;
  add(one, 1, 0, 0), add(one, 10, 5, 1), add(one, 10, 5, 2), add(one, 20, 5, 0);
  add(empty, 10, 0, 3);
  const std::vector<LabelledScene> scenes = {four_things(), one, empty};
  const ReferenceSummary summary = reference_summary(scenes);
  // The scene without truth leaves the mean; its wrong prediction stays in the pool.
  EXPECT_DOUBLE_EQ(summary.scene_mean.miou, (0.65 + 0.25) / 2);
  EXPECT_DOUBLE_EQ(summary.pooled.miou, (0.5 + 0.8 + 0.25) / 3);
  EXPECT_DOUBLE_EQ(summary.scene_mean.ap25, (0.75 + 1) / 2);
  EXPECT_DOUBLE_EQ(summary.pooled.ap25, 5.0 / 7);
  EXPECT_EQ(summary.pooled.predicted_instances, 7);
  EXPECT_EQ(summary.scene_mean.truth_instances, 3);
  EXPECT_EQ(reference_summary({}).pooled.miou, 0);
}

TEST(ReferenceScores, DoNotDependOnPredictedNamesOrVertexOrder) {
  const LabelledScene scene = four_things();
  LabelledScene other;
  for (std::size_t i = scene.truth.size(); i-- > 0;) {
    other.truth.push_back(10 * scene.truth[i] + 3);  // keeps the order of truth ids
    other.predicted.push_back(scene.predicted[i] ? 100 - scene.predicted[i] : 0);
  }
  EXPECT_EQ(reference_scores(other).miou, reference_scores(scene).miou);
  EXPECT_EQ(reference_scores(other).ap50, reference_scores(scene).ap50);
}

}  // namespace
}  // namespace ovimap
