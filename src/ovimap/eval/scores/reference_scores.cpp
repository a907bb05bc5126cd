// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scores/reference_scores.h"

#include <algorithm>
#include <array>
#include <vector>

#include "ovimap/base/config.h"
#include "ovimap/eval/scenes/overlap.h"

namespace ovimap {

namespace {

constexpr std::array<int, 3> kPercents = {25, 50, 75};

/// What is summed over instances, and over scenes for the pooled figures.
struct Sums {
  double iou = 0, weighted_iou = 0, truth_vertices = 0;
  std::array<int, kPercents.size()> right{};
  int truth = 0, predicted = 0;

  void add(const Sums& other) {
    iou += other.iou;
    weighted_iou += other.weighted_iou;
    truth_vertices += other.truth_vertices;
    for (std::size_t i = 0; i < right.size(); ++i) right[i] += other.right[i];
    truth += other.truth;
    predicted += other.predicted;
  }
};

Sums sums_of(const LabelledScene& scene, const ReferenceProtocolConfig& config) {
  const InstanceOverlaps table =
      count_overlaps(scene.truth, scene.predicted, Background::kLowestId);
  std::vector<double> best_iou(table.truth.size(), 0);
  std::vector<std::array<bool, kPercents.size()>> right(table.predicted.size());
  for (const InstanceOverlap& overlap : table.overlaps) {
    best_iou[overlap.truth] = std::max(best_iou[overlap.truth], overlap.iou());
    if (table.truth[overlap.truth].vertices < config.min_vertices) continue;
    for (std::size_t i = 0; i < kPercents.size(); ++i)
      if (overlap.reaches(kPercents[i])) right[overlap.predicted][i] = true;
  }
  Sums sums;
  for (std::size_t t = 0; t < table.truth.size(); ++t) {
    if (table.truth[t].vertices < config.min_vertices) continue;
    const auto vertices = static_cast<double>(table.truth[t].vertices);
    ++sums.truth;
    sums.iou += best_iou[t];
    sums.weighted_iou += best_iou[t] * vertices;
    sums.truth_vertices += vertices;
  }
  for (std::size_t p = 0; p < table.predicted.size(); ++p) {
    if (table.predicted[p].vertices < config.min_vertices) continue;
    ++sums.predicted;
    for (std::size_t i = 0; i < kPercents.size(); ++i) sums.right[i] += right[p][i];
  }
  return sums;
}

double ratio(double part, double whole) {
  return whole > 0 ? part / whole : 0;
}

ReferenceScores scores_of(const Sums& sums) {
  const auto precision = [&](std::size_t i) { return ratio(sums.right[i], sums.predicted); };
  const auto recall = [&](std::size_t i) { return ratio(sums.right[i], sums.truth); };
  ReferenceScores scores;
  scores.miou = ratio(sums.iou, sums.truth);
  scores.wiou = ratio(sums.weighted_iou, sums.truth_vertices);
  scores.ap25 = precision(0), scores.ap50 = precision(1), scores.ap75 = precision(2);
  scores.recall25 = recall(0), scores.recall50 = recall(1), scores.recall75 = recall(2);
  scores.truth_instances = sums.truth;
  scores.predicted_instances = sums.predicted;
  return scores;
}

}  // namespace

void list_fields(ReferenceProtocolConfig& config, ConfigFields& fields) {
  fields.add("min_vertices", config.min_vertices, 1, 1000000,
             "instances with fewer truth vertices do not count in the reference protocol");
}

ReferenceSummary reference_summary(std::span<const LabelledScene> scenes,
                                   const ReferenceProtocolConfig& config) {
  constexpr std::array kFigures = {&ReferenceScores::miou,     &ReferenceScores::wiou,
                                   &ReferenceScores::ap25,     &ReferenceScores::ap50,
                                   &ReferenceScores::ap75,     &ReferenceScores::recall25,
                                   &ReferenceScores::recall50, &ReferenceScores::recall75};
  ReferenceSummary summary;
  Sums all;
  int with_truth = 0;
  for (const LabelledScene& scene : scenes) {
    const Sums sums = sums_of(scene, config);
    all.add(sums);
    if (sums.truth == 0) continue;
    ++with_truth;
    const ReferenceScores scores = scores_of(sums);
    for (const auto figure : kFigures) summary.scene_mean.*figure += scores.*figure;
  }
  for (const auto figure : kFigures)
    summary.scene_mean.*figure = ratio(summary.scene_mean.*figure, with_truth);
  summary.pooled = scores_of(all);
  summary.scene_mean.truth_instances = summary.pooled.truth_instances;
  summary.scene_mean.predicted_instances = summary.pooled.predicted_instances;
  return summary;
}

}  // namespace ovimap
