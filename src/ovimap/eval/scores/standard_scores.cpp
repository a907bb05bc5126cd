// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scores/standard_scores.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "ovimap/eval/scores/average_precision.h"

namespace ovimap {

namespace {

ScoredOverlaps scored(const LabelledScene& scene) {
  ScoredOverlaps result{count_overlaps(scene.truth, scene.predicted, Background::kNotPositive), {}};
  for (const InstanceSize& instance : result.table.predicted)
    result.confidence.push_back(confidence_of(scene, instance));
  return result;
}

double sum_of_best_ious(const InstanceOverlaps& table) {
  std::vector<double> best(table.truth.size(), 0);
  for (const InstanceOverlap& overlap : table.overlaps)
    best[overlap.truth] = std::max(best[overlap.truth], overlap.iou());
  return std::accumulate(best.begin(), best.end(), 0.0);
}

}  // namespace

StandardScores standard_scores(std::span<const LabelledScene> scenes) {
  StandardScores scores;
  std::vector<ScoredOverlaps> tables;
  double iou_sum = 0;
  for (const LabelledScene& scene : scenes) {
    tables.push_back(scored(scene));
    scores.truth_instances += static_cast<int>(tables.back().table.truth.size());
    scores.predicted_instances += static_cast<int>(tables.back().table.predicted.size());
    iou_sum += sum_of_best_ious(tables.back().table);
  }
  if (scores.truth_instances == 0) return scores;
  scores.miou = iou_sum / scores.truth_instances;
  const auto at = [&](int percent) { return ranked_precision(tables, percent); };
  const PrecisionRecall at25 = at(25), at50 = at(50), at75 = at(75);
  scores.ap25 = at25.average_precision, scores.recall25 = at25.recall;
  scores.ap50 = at50.average_precision, scores.recall50 = at50.recall;
  scores.ap75 = at75.average_precision, scores.recall75 = at75.recall;
  scores.ap =
      mean_precision(kLastPercent, [&](int percent) { return at(percent).average_precision; });
  return scores;
}

}  // namespace ovimap
