// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/standard_scores.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "ovimap/eval/overlap.h"

namespace ovimap {

namespace {

struct RankedPrediction {
  float confidence = 0;
  std::size_t scene = 0, position = 0;  // in the scene's InstanceOverlaps::predicted
};

struct PrecisionRecall {
  double average_precision = 0, recall = 0;
};

enum class Verdict { kRight, kWrong, kIgnored };

float confidence_of(const LabelledScene& scene, const InstanceSize& instance) {
  if (scene.confidence.empty()) return static_cast<float>(instance.vertices);
  const auto found = scene.confidence.find(static_cast<std::uint32_t>(instance.id));
  return found == scene.confidence.end() ? std::numeric_limits<float>::lowest() : found->second;
}

std::vector<RankedPrediction> rank_predictions(std::span<const LabelledScene> scenes,
                                               const std::vector<InstanceOverlaps>& tables) {
  std::vector<RankedPrediction> ranked;
  for (std::size_t s = 0; s < scenes.size(); ++s)
    for (std::size_t p = 0; p < tables[s].predicted.size(); ++p)
      ranked.push_back({confidence_of(scenes[s], tables[s].predicted[p]), s, p});
  // Stable: ties stay in the order of scenes and ids.
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.confidence > b.confidence; });
  return ranked;
}

/// Matches one prediction at an IoU threshold and marks the truth instance it takes.
Verdict match(const InstanceOverlaps& table, std::size_t predicted, int percent,
              std::vector<bool>& taken) {
  const InstanceOverlap* best = nullptr;
  bool reached = false;
  for (const InstanceOverlap& overlap : table.of_predicted(predicted)) {
    if (!overlap.reaches(percent)) continue;
    reached = true;
    if (!taken[overlap.truth] && (!best || overlap.iou() > best->iou())) best = &overlap;
  }
  if (best) {
    taken[best->truth] = true;
    return Verdict::kRight;
  }
  const bool unknown =
      table.unlabelled[predicted] * 100 > percent * table.predicted[predicted].vertices;
  return !reached && unknown ? Verdict::kIgnored : Verdict::kWrong;
}

PrecisionRecall precision_recall(const std::vector<InstanceOverlaps>& tables,
                                 const std::vector<RankedPrediction>& ranked, int truth_instances,
                                 int percent) {
  if (truth_instances == 0) return {};
  std::vector<std::vector<bool>> taken;
  for (const InstanceOverlaps& table : tables) taken.emplace_back(table.truth.size(), false);
  std::vector<double> precision;  // at each right prediction
  int counted = 0;
  for (const RankedPrediction& prediction : ranked) {
    const Verdict verdict =
        match(tables[prediction.scene], prediction.position, percent, taken[prediction.scene]);
    if (verdict != Verdict::kIgnored) ++counted;
    if (verdict == Verdict::kRight)
      precision.push_back(static_cast<double>(precision.size() + 1) / counted);
  }
  for (std::size_t i = precision.size(); i-- > 1;)
    precision[i - 1] = std::max(precision[i - 1], precision[i]);
  return {std::accumulate(precision.begin(), precision.end(), 0.0) / truth_instances,
          static_cast<double>(precision.size()) / truth_instances};
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
  std::vector<InstanceOverlaps> tables;
  double iou_sum = 0;
  for (const LabelledScene& scene : scenes) {
    tables.push_back(count_overlaps(scene.truth, scene.predicted, Background::kNotPositive));
    scores.truth_instances += static_cast<int>(tables.back().truth.size());
    scores.predicted_instances += static_cast<int>(tables.back().predicted.size());
    iou_sum += sum_of_best_ious(tables.back());
  }
  if (scores.truth_instances == 0) return scores;
  scores.miou = iou_sum / scores.truth_instances;
  const std::vector<RankedPrediction> ranked = rank_predictions(scenes, tables);
  const auto at = [&](int percent) {
    return precision_recall(tables, ranked, scores.truth_instances, percent);
  };
  const PrecisionRecall at25 = at(25), at50 = at(50), at75 = at(75);
  scores.ap25 = at25.average_precision, scores.recall25 = at25.recall;
  scores.ap50 = at50.average_precision, scores.recall50 = at50.recall;
  scores.ap75 = at75.average_precision, scores.recall75 = at75.recall;
  constexpr int kFirstPercent = 50, kLastPercent = 95, kStepPercent = 5;
  int thresholds = 0;
  for (int percent = kFirstPercent; percent <= kLastPercent; percent += kStepPercent, ++thresholds)
    scores.ap += at(percent).average_precision;
  scores.ap /= thresholds;
  return scores;
}

}  // namespace ovimap
