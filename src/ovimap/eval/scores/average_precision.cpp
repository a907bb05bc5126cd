// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scores/average_precision.h"

#include <algorithm>
#include <numeric>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

struct RankedPrediction {
  double confidence = 0;
  std::size_t scene = 0, position = 0;  // in the scene's InstanceOverlaps::predicted
};

enum class Verdict { kRight, kWrong, kIgnored };

std::vector<RankedPrediction> rank_predictions(std::span<const ScoredOverlaps> scenes) {
  std::vector<RankedPrediction> ranked;
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    OVIMAP_ASSERT(scenes[s].confidence.size() == scenes[s].table.predicted.size());
    for (std::size_t p = 0; p < scenes[s].confidence.size(); ++p)
      ranked.push_back({scenes[s].confidence[p], s, p});
  }
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

/// What the benchmark makes of all scenes at one threshold.
struct BenchmarkOutcome {
  std::vector<std::pair<double, bool>> judged;  ///< confidence; whether it is right
  int missed = 0, counted_truth = 0;
};

/// Truth instances in turn: the most confident prediction above the threshold is right, the others
/// are wrong. A prediction that was right once is not looked at again.
void judge_matched(const ScoredOverlaps& scene, int percent, int min_vertices,
                   BenchmarkOutcome& outcome) {
  const InstanceOverlaps& table = scene.table;
  std::vector<std::vector<const InstanceOverlap*>> on_truth(table.truth.size());
  for (const InstanceOverlap& overlap : table.overlaps)
    if (overlap.exceeds(percent) && table.predicted[overlap.predicted].vertices >= min_vertices)
      on_truth[overlap.truth].push_back(&overlap);
  std::vector<bool> used(table.predicted.size(), false);
  for (std::size_t t = 0; t < table.truth.size(); ++t) {
    if (table.truth[t].vertices < min_vertices) continue;
    ++outcome.counted_truth;
    std::optional<double> best;
    for (const InstanceOverlap* overlap : on_truth[t]) {
      if (used[overlap->predicted]) continue;
      const double confidence = scene.confidence[overlap->predicted];
      if (!best) {
        best = confidence;
        used[overlap->predicted] = true;
      } else {
        outcome.judged.emplace_back(std::min(*best, confidence), false);
        best = std::max(*best, confidence);
      }
    }
    if (best)
      outcome.judged.emplace_back(*best, true);
    else
      ++outcome.missed;
  }
}

/// Predictions that are above the threshold with no truth instance, the small ones included.
void judge_unmatched(const ScoredOverlaps& scene, int percent, int min_vertices,
                     BenchmarkOutcome& outcome) {
  const InstanceOverlaps& table = scene.table;
  for (std::size_t p = 0; p < table.predicted.size(); ++p) {
    if (table.predicted[p].vertices < min_vertices) continue;
    std::int64_t ignorable = table.unlabelled[p];
    bool matched = false;
    for (const InstanceOverlap& overlap : table.of_predicted(p)) {
      matched = matched || overlap.exceeds(percent);
      if (table.truth[overlap.truth].vertices < min_vertices) ignorable += overlap.shared;
    }
    if (!matched && ignorable * 100 <= percent * table.predicted[p].vertices)
      outcome.judged.emplace_back(scene.confidence[p], false);
  }
}

/// Trapezoids between the precision-recall points of every distinct confidence, and the made-up
/// point of precision 1 at recall 0.
double area_of_trapezoids(BenchmarkOutcome outcome) {
  std::sort(outcome.judged.begin(), outcome.judged.end());
  const auto count = static_cast<double>(outcome.judged.size());
  double right = 0;
  for (const auto& judged : outcome.judged) right += judged.second;
  const double truth = right + outcome.missed;
  std::vector<double> precision, recall;
  double right_below = 0;
  for (std::size_t i = 0; i < outcome.judged.size(); ++i) {
    if (i == 0 || outcome.judged[i].first != outcome.judged[i - 1].first) {
      precision.push_back((right - right_below) / (count - static_cast<double>(i)));
      recall.push_back((right - right_below) / truth);
    }
    right_below += outcome.judged[i].second;
  }
  precision.push_back(1), recall.push_back(0);
  double area = 0;
  for (std::size_t i = 0; i < precision.size(); ++i) {
    const double before = recall[i == 0 ? 0 : i - 1];
    const double after = i + 1 < recall.size() ? recall[i + 1] : 0;
    area += precision[i] * (before - after) / 2;
  }
  return area;
}

}  // namespace

PrecisionRecall ranked_precision(std::span<const ScoredOverlaps> scenes, int percent) {
  double truth_instances = 0;
  std::vector<std::vector<bool>> taken;
  for (const ScoredOverlaps& scene : scenes) {
    truth_instances += static_cast<double>(scene.table.truth.size());
    taken.emplace_back(scene.table.truth.size(), false);
  }
  if (truth_instances == 0) return {};
  std::vector<double> precision;  // at each right prediction
  int counted = 0;
  for (const RankedPrediction& prediction : rank_predictions(scenes)) {
    const Verdict verdict = match(scenes[prediction.scene].table, prediction.position, percent,
                                  taken[prediction.scene]);
    if (verdict != Verdict::kIgnored) ++counted;
    if (verdict == Verdict::kRight)
      precision.push_back(static_cast<double>(precision.size() + 1) / counted);
  }
  for (std::size_t i = precision.size(); i-- > 1;)
    precision[i - 1] = std::max(precision[i - 1], precision[i]);
  return {std::accumulate(precision.begin(), precision.end(), 0.0) / truth_instances,
          static_cast<double>(precision.size()) / truth_instances};
}

std::optional<double> benchmark_precision(std::span<const ScoredOverlaps> scenes, int percent,
                                          int min_vertices) {
  BenchmarkOutcome outcome;
  for (const ScoredOverlaps& scene : scenes) {
    OVIMAP_ASSERT(scene.confidence.size() == scene.table.predicted.size());
    judge_matched(scene, percent, min_vertices, outcome);
    judge_unmatched(scene, percent, min_vertices, outcome);
  }
  if (outcome.counted_truth == 0) return std::nullopt;
  return area_of_trapezoids(std::move(outcome));
}

}  // namespace ovimap
