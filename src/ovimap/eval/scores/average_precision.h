// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ovimap/eval/scenes/overlap.h"

namespace ovimap {

/// The instances of one scene (of one class, where classes count) and how sure each prediction is.
/// `table.unlabelled` counts the vertices that must not make a prediction wrong.
struct ScoredOverlaps {
  InstanceOverlaps table;
  std::vector<double> confidence;  ///< per table.predicted; higher ranks first
};

/// IoU thresholds that `AP` averages over, in percent.
constexpr int kFirstPercent = 50, kLastPercent = 95;

/// `AP`: the mean of what `precision_at(percent)` gives for every fifth percent from kFirstPercent
/// to `last_percent`.
template <class PrecisionAt>
double mean_precision(int last_percent, const PrecisionAt& precision_at) {
  constexpr int kStepPercent = 5;
  double sum = 0;
  int thresholds = 0;
  for (int percent = kFirstPercent; percent <= last_percent; percent += kStepPercent, ++thresholds)
    sum += precision_at(percent);
  return sum / thresholds;
}

struct PrecisionRecall {
  double average_precision = 0, recall = 0;
};

/// One-to-one average precision at an IoU of at least `percent`, of all scenes in one ranking.
///
/// Predictions are taken by descending confidence (ties: scene order, then lower id); each is
/// matched to the free truth instance with which its IoU is highest, at least the threshold. One
/// that reaches no truth instance is wrong, unless a larger share of it than the threshold is
/// unlabelled: then it is ignored. The area lies under the precision-recall curve with precision
/// made non-increasing. Zeros without truth instances.
PrecisionRecall ranked_precision(std::span<const ScoredOverlaps> scenes, int percent);

/// Average precision as the ScanNet benchmark (and with it the paper) computes it: IoU strictly
/// above `percent`; truth instances are visited in turn, and of several predictions above the
/// threshold on one of them the less confident are wrong; truth instances of fewer than
/// `min_vertices` do not count, and what lies on them is unlabelled; predictions that reach no
/// truth instance are wrong unless a larger share than the threshold is unlabelled; the area is the
/// sum of trapezoids between the distinct confidences. Predictions below `min_vertices` are left
/// out. nullopt when no truth instance counts.
std::optional<double> benchmark_precision(std::span<const ScoredOverlaps> scenes, int percent,
                                          int min_vertices);

}  // namespace ovimap
