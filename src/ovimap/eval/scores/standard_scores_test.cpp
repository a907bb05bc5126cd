// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scores/standard_scores.h"

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

/// Appends `count` vertices of one truth and one predicted id.
void put(LabelledScene& scene, int count, std::int32_t truth, std::uint32_t predicted) {
  scene.truth.insert(scene.truth.end(), static_cast<std::size_t>(count), truth);
  scene.predicted.insert(scene.predicted.end(), static_cast<std::size_t>(count), predicted);
}

/// Three true things of ten vertices; IoU: 11 with 1 8/12, 12 with 2 8/10, 13 with 3 4/10, 14 with
/// 3 5/10.
LabelledScene three_things() {
  LabelledScene scene;
  put(scene, 8, 1, 11), put(scene, 2, 1, 0);
  put(scene, 2, 2, 11), put(scene, 8, 2, 12);
  put(scene, 4, 3, 13), put(scene, 5, 3, 14), put(scene, 1, 3, 0);
  scene.confidence = {{11, 0.8f}, {12, 0.6f}, {13, 0.9f}, {14, 0.7f}};
  return scene;
}

StandardScores scores_of(const LabelledScene& scene) {
  return standard_scores({&scene, 1});
}

TEST(StandardScores, AreAsComputedByHand) {
  const StandardScores scores = scores_of(three_things());
  EXPECT_EQ(scores.truth_instances, 3);
  EXPECT_EQ(scores.predicted_instances, 4);
  EXPECT_DOUBLE_EQ(scores.miou, (8.0 / 12 + 8.0 / 10 + 5.0 / 10) / 3);
  // Ranked 13, 11, 14, 12. At 0.25 only 14 is wrong (its thing is taken): precision 1, 1, 3/4.
  EXPECT_DOUBLE_EQ(scores.ap25, (1 + 1 + 0.75) / 3);
  // At 0.50 13 is wrong, the others right: precision 1/2, 2/3, 3/4, made non-increasing 3/4.
  EXPECT_DOUBLE_EQ(scores.ap50, 0.75);
  // At 0.75 only the last, 12, is right: precision 1/4 at one of three things.
  EXPECT_DOUBLE_EQ(scores.ap75, 0.25 / 3);
  EXPECT_DOUBLE_EQ(scores.recall25, 1);
  EXPECT_DOUBLE_EQ(scores.recall75, 1.0 / 3);
  // 0.50: 3/4; 0.55, 0.60, 0.65: 11 and 12, 1/3 each; 0.70, 0.75, 0.80: 12 alone; above: none.
  EXPECT_DOUBLE_EQ(scores.ap, (0.75 + 3 * (1.0 / 3) + 3 * (0.25 / 3)) / 10);
}

TEST(StandardScores, APerfectPredictionScoresOne) {
  LabelledScene scene;
  put(scene, 1, 1, 9), put(scene, 50, 2, 8), put(scene, 7, 3, 7);
  const StandardScores scores = scores_of(scene);
  for (const double figure : {scores.miou, scores.ap25, scores.ap50, scores.ap75, scores.ap,
                              scores.recall25, scores.recall50, scores.recall75})
    EXPECT_EQ(figure, 1);
}

TEST(StandardScores, NothingPredictedOrNothingTrueScoresZero) {
  LabelledScene unpredicted, untrue;
  put(unpredicted, 10, 1, 0);
  put(untrue, 10, 0, 4);
  for (const LabelledScene& scene : {unpredicted, untrue, LabelledScene{}}) {
    const StandardScores scores = scores_of(scene);
    for (const double figure : {scores.miou, scores.ap25, scores.ap50, scores.ap75, scores.ap,
                                scores.recall25, scores.recall50, scores.recall75})
      EXPECT_EQ(figure, 0);
  }
  EXPECT_EQ(scores_of(untrue).predicted_instances, 1);
}

TEST(StandardScores, EveryTruthIdCounts) {
  LabelledScene scene;
  put(scene, 30, 1, 5), put(scene, 10, 2, 0);
  EXPECT_EQ(scores_of(scene).truth_instances, 2);
  EXPECT_EQ(scores_of(scene).miou, 0.5);
}

// Prediction 1 lies with 6 of 10 vertices where the truth says nothing.
TEST(StandardScores, APredictionOnUnlabelledTruthIsIgnoredWhereItReachesNothing) {
  LabelledScene scene;
  put(scene, 6, 0, 1), put(scene, 4, 1, 1), put(scene, 6, 1, 2);
  scene.confidence = {{1, 0.9f}, {2, 0.1f}};
  const StandardScores scores = scores_of(scene);
  EXPECT_EQ(scores.ap25, 1);  // it reaches 4/16 and takes the thing
  EXPECT_EQ(scores.ap50,
            1);  // 60 % of it is unknown, more than 50 %: ignored, so 2 (6/10) ranks first
  EXPECT_EQ(scores.ap75, 0);
  LabelledScene half = scene;
  std::fill(half.truth.begin(), half.truth.begin() + 1, 1);
  // Now 5 of 10 are unknown, which is not more than half: a wrong one ahead of the right one
  // (6/11).
  EXPECT_EQ(scores_of(half).ap50, 0.5);
}

TEST(StandardScores, WithoutConfidencesTheLargerRanksFirst) {
  LabelledScene scene;
  put(scene, 20, 1, 1), put(scene, 10, 2, 2), put(scene, 25, 2, 0), put(scene, 2, 0, 3);
  EXPECT_DOUBLE_EQ(scores_of(scene).ap50, 0.5);  // 1 right, then 2 wrong
  scene.confidence = {{2, 0.5f}};                // an instance that is not named ranks last
  EXPECT_DOUBLE_EQ(scores_of(scene).ap50, 0.25);
}

TEST(StandardScores, ScenesArePooledInOneRanking) {
  LabelledScene good, bad;
  put(good, 10, 1, 1);
  put(bad, 10, 1, 1), put(bad, 90, 1, 0);
  good.confidence = {{1, 0.4f}};
  bad.confidence = {{1, 0.6f}};
  const std::vector<LabelledScene> scenes = {good, bad};
  const StandardScores scores = standard_scores(scenes);
  EXPECT_DOUBLE_EQ(scores.ap50, 0.25);  // wrong first, then right at precision 1/2, of two things
  EXPECT_DOUBLE_EQ(scores.miou, 0.55);
}

LabelledScene random_scene(unsigned seed) {
  std::mt19937 random(seed);
  LabelledScene scene;
  // Runs of vertices, so that overlaps of every size come up.
  for (int run = 0; run < 60; ++run)
    put(scene, 1 + static_cast<int>(random() % 40), static_cast<std::int32_t>(random() % 9),
        random() % 3 ? static_cast<std::uint32_t>(scene.truth.empty() ? 1 : scene.truth.back() + 1)
                     : static_cast<std::uint32_t>(random() % 12));
  for (std::uint32_t id = 1; id < 12; ++id)
    scene.confidence[id] = static_cast<float>(random() % 1000) + static_cast<float>(id) / 16;
  return scene;
}

/// Average precision from its definition, on sets of vertices: at each recall level the best
/// precision of any prefix of the ranking that reaches it.
double naive_average_precision(const LabelledScene& scene, double threshold) {
  std::map<std::int32_t, std::set<std::size_t>> truth;
  std::map<std::uint32_t, std::set<std::size_t>> predicted;
  for (std::size_t i = 0; i < scene.truth.size(); ++i) {
    if (scene.truth[i] > 0) truth[scene.truth[i]].insert(i);
    if (scene.predicted[i] > 0) predicted[scene.predicted[i]].insert(i);
  }
  std::vector<std::pair<float, std::uint32_t>> ranking;
  for (const auto& entry : predicted)
    ranking.emplace_back(-scene.confidence.at(entry.first), entry.first);
  std::sort(ranking.begin(), ranking.end());
  std::set<std::int32_t> taken;
  std::vector<std::pair<double, double>> curve;  // recall, precision
  double right = 0, counted = 0;
  for (const auto& [key, id] : ranking) {
    const std::set<std::size_t>& mask = predicted[id];
    double best = 0, best_any = 0, known = 0;
    std::int32_t best_id = 0;
    for (const auto& [truth_id, vertices] : truth) {
      std::vector<std::size_t> shared;
      std::set_intersection(mask.begin(), mask.end(), vertices.begin(), vertices.end(),
                            std::back_inserter(shared));
      const double both = static_cast<double>(shared.size());
      const double iou = both / (static_cast<double>(mask.size() + vertices.size()) - both);
      known += both;
      best_any = std::max(best_any, iou);
      if (!taken.count(truth_id) && iou > best) best = iou, best_id = truth_id;
    }
    if (best >= threshold) {
      taken.insert(best_id);
      ++right;
    } else if (best_any < threshold && 1 - known / static_cast<double>(mask.size()) > threshold) {
      continue;
    }
    ++counted;
    curve.emplace_back(right / static_cast<double>(truth.size()), right / counted);
  }
  double area = 0;
  for (std::size_t level = 1; level <= truth.size(); ++level) {
    double best = 0;
    for (const auto& [recall, precision] : curve)
      if (recall >= static_cast<double>(level) / static_cast<double>(truth.size()) - 1e-12)
        best = std::max(best, precision);
    area += best / static_cast<double>(truth.size());
  }
  return area;
}

TEST(StandardScores, AgreeWithTheDefinitionOnRandomScenes) {
  double sum = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const LabelledScene scene = random_scene(seed);
    const StandardScores scores = scores_of(scene);
    EXPECT_NEAR(scores.ap25, naive_average_precision(scene, 0.25), 1e-12) << seed;
    EXPECT_NEAR(scores.ap50, naive_average_precision(scene, 0.50), 1e-12) << seed;
    EXPECT_NEAR(scores.ap75, naive_average_precision(scene, 0.75), 1e-12) << seed;
    sum += scores.ap25 - scores.ap75;
  }
  EXPECT_GT(sum, 1);  // the scenes are not all trivial
}

TEST(StandardScores, DoNotDependOnNamesOrVertexOrder) {
  const LabelledScene scene = random_scene(99);
  LabelledScene renamed;
  std::vector<std::size_t> order(scene.truth.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  const auto truth_name = [](std::int32_t id) { return id > 0 ? 1000 - 7 * id : id; };
  const auto predicted_name = [](std::uint32_t id) { return id ? 500 - 3 * id : 0; };
  for (const std::size_t i : order) {
    renamed.truth.push_back(truth_name(scene.truth[i]));
    renamed.predicted.push_back(predicted_name(scene.predicted[i]));
  }
  for (const auto& [id, confidence] : scene.confidence)
    renamed.confidence[predicted_name(id)] = confidence;
  const StandardScores before = scores_of(scene), after = scores_of(renamed);
  EXPECT_NEAR(before.miou, after.miou, 1e-12);
  EXPECT_EQ(before.ap25, after.ap25);
  EXPECT_EQ(before.ap, after.ap);
  EXPECT_EQ(before.recall50, after.recall50);
  EXPECT_GT(before.ap25, 0);
}

}  // namespace
}  // namespace ovimap
