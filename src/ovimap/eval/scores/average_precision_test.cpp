// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scores/average_precision.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

constexpr int kMinVertices = 100;

/// Overlaps given by hand: {truth, predicted, shared} by position.
struct Shared {
  std::size_t truth, predicted;
  std::int64_t vertices;
};

ScoredOverlaps table_of(const std::vector<std::int64_t>& truth,
                        const std::vector<std::int64_t>& predicted,
                        const std::vector<double>& confidence, const std::vector<Shared>& shared) {
  ScoredOverlaps scene;
  for (const std::int64_t size : truth)
    scene.table.truth.push_back({static_cast<std::int64_t>(scene.table.truth.size()) + 1, size});
  for (const std::int64_t size : predicted)
    scene.table.predicted.push_back(
        {static_cast<std::int64_t>(scene.table.predicted.size()) + 1, size});
  for (const Shared& s : shared)
    scene.table.overlaps.push_back(
        {s.truth, s.predicted, s.vertices, truth[s.truth] + predicted[s.predicted] - s.vertices});
  scene.table.unlabelled.assign(predicted.size(), 0);
  scene.confidence = confidence;
  return scene;
}

double benchmark(const ScoredOverlaps& scene, int percent) {
  return benchmark_precision({&scene, 1}, percent, kMinVertices).value_or(-1);
}

/// IoU 0.8 at 0.9, nothing at 0.7, IoU 0.6 at 0.5.
ScoredOverlaps two_right_one_wrong() {
  return table_of({200, 200}, {160, 100, 120}, {0.9, 0.7, 0.5}, {{0, 0, 160}, {1, 2, 120}});
}

TEST(RankedPrecision, IsAsComputedByHand) {
  const ScoredOverlaps scene = two_right_one_wrong();
  const PrecisionRecall at50 = ranked_precision({&scene, 1}, 50);
  EXPECT_DOUBLE_EQ(at50.average_precision, (1 + 2.0 / 3) / 2);
  EXPECT_DOUBLE_EQ(at50.recall, 1);
  const PrecisionRecall at75 = ranked_precision({&scene, 1}, 75);
  EXPECT_DOUBLE_EQ(at75.average_precision, 0.5);
  EXPECT_DOUBLE_EQ(at75.recall, 0.5);
  EXPECT_EQ(ranked_precision({}, 50).average_precision, 0);
}

TEST(BenchmarkPrecision, IsAsComputedByHand) {
  // Points (recall, precision) from the least confident on: (1, 2/3), (1/2, 1/2), (1/2, 1), and the
  // made-up (0, 1); each weighs half of the recall between its neighbours.
  EXPECT_DOUBLE_EQ(benchmark(two_right_one_wrong(), 50),
                   2.0 / 3 * 0.25 + 0.5 * 0.25 + 1 * 0.25 + 1 * 0.25);
  // At 0.75 the last is wrong and one truth missed: (1/2, 1/3), (1/2, 1/2), (1/2, 1), (0, 1).
  EXPECT_DOUBLE_EQ(benchmark(two_right_one_wrong(), 75), 0 + 0 + 0.25 + 0.25);
}

TEST(BenchmarkPrecision, ReachingTheThresholdIsNotEnough) {
  const ScoredOverlaps scene = table_of({200}, {100}, {1}, {{0, 0, 100}});
  EXPECT_EQ(benchmark(scene, 50), 0);
  EXPECT_EQ(benchmark(scene, 45), 1);
  EXPECT_EQ(ranked_precision({&scene, 1}, 50).average_precision, 1);
}

TEST(BenchmarkPrecision, OfTwoOnOneTruthTheLessConfidentIsWrong) {
  for (const bool first_is_surer : {true, false}) {
    const double first = first_is_surer ? 0.9 : 0.3;
    // Both reach 0.25 on the one truth; a third truth-less one lies between them.
    const ScoredOverlaps scene =
        table_of({400}, {200, 160, 100}, {first, 1.2 - first, 0.5}, {{0, 0, 200}, {0, 1, 160}});
    // (1, 1/3), (1, 1/2), (1, 1), (0, 1): only the last two weigh.
    EXPECT_DOUBLE_EQ(benchmark(scene, 25), 1);
    // At 0.45 only the first is right: with the wrong ones ahead of it, (1, 1/3), (0, 0), (0, 0).
    EXPECT_DOUBLE_EQ(benchmark(scene, 45), first_is_surer ? 1 : 1.0 / 3 / 2);
  }
}

TEST(BenchmarkPrecision, APredictionIsRightOnce) {
  // Half of it on either truth: the first takes it, the second is missed.
  const ScoredOverlaps scene = table_of({200, 200}, {400}, {1}, {{0, 0, 200}, {1, 0, 200}});
  EXPECT_DOUBLE_EQ(benchmark(scene, 25), 0.5);
}

TEST(BenchmarkPrecision, EqualConfidencesAreOnePoint) {
  const ScoredOverlaps scene =
      table_of({200, 200}, {160, 100, 120}, {0.5, 0.5, 0.5}, {{0, 0, 160}, {1, 2, 120}});
  // (1, 2/3), (0, 1)
  EXPECT_DOUBLE_EQ(benchmark(scene, 50), (2.0 / 3 + 1) / 2);
}

TEST(BenchmarkPrecision, SmallInstancesDoNotCount) {
  // The second truth and the third prediction have under 100 vertices.
  ScoredOverlaps scene =
      table_of({200, 99}, {200, 100, 99}, {0.5, 0.9, 0.8}, {{0, 0, 200}, {1, 1, 60}, {1, 2, 39}});
  // At 0.25 the second prediction is on the small truth (60/139) and not wrong.
  EXPECT_EQ(benchmark(scene, 25), 1);
  // At 0.50 it reaches nothing; 60 of 100 vertices are on what does not count: ignored.
  EXPECT_EQ(benchmark(scene, 50), 1);
  // At 0.60 no more than the threshold is: wrong, and ahead of the right one.
  EXPECT_DOUBLE_EQ(benchmark(scene, 60), 0.5 / 2);
  scene.table.unlabelled[1] = 1;  // 61 of 100
  EXPECT_EQ(benchmark(scene, 60), 1);
  const ScoredOverlaps nothing = table_of({99}, {100}, {1}, {{0, 0, 99}});
  EXPECT_FALSE(benchmark_precision({&nothing, 1}, 50, kMinVertices).has_value());
}

TEST(BenchmarkPrecision, WithoutPredictionsItIsZero) {
  EXPECT_EQ(benchmark(table_of({100}, {}, {}, {}), 25), 0);
}

TEST(BenchmarkPrecision, ScenesArePooled) {
  const ScoredOverlaps right = table_of({200}, {200}, {0.4}, {{0, 0, 200}});
  const ScoredOverlaps wrong = table_of({200}, {200}, {0.6}, {});
  const std::vector<ScoredOverlaps> scenes = {right, wrong};
  // (1/2, 1/2), (0, 0), (0, 1): the first weighs 1/4, the second 1/4.
  EXPECT_DOUBLE_EQ(*benchmark_precision(scenes, 50, kMinVertices), 0.5 * 0.25);
}

}  // namespace
}  // namespace ovimap
