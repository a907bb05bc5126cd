// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "ovimap/eval/scenes/labelled_scene.h"

namespace ovimap {

/// Class-agnostic figures of the `standard` protocol, all in [0, 1]. A figure whose denominator is
/// zero is 0; the counts tell.
struct StandardScores {
  double miou = 0;  ///< mean over truth instances of the best IoU with any predicted instance
  double ap25 = 0, ap50 = 0, ap75 = 0;              ///< average precision at that IoU
  double ap = 0;                                    ///< mean over IoU 0.50, 0.55, ... 0.95
  double recall25 = 0, recall50 = 0, recall75 = 0;  ///< truth instances matched one-to-one
  int truth_instances = 0, predicted_instances = 0;
};

/// Scores one or several scenes together, pooled: the mean IoU runs over the truth instances of all
/// scenes, and the predictions of all scenes are ranked in one list.
///
/// Every truth id above 0 counts. Predictions are taken by descending confidence (ties: scene
/// order, then lower id); each is matched to the free truth instance with which its IoU is highest,
/// at least the threshold. One that reaches no truth instance is wrong, unless a larger share of it
/// than the threshold lies on unlabelled truth: then it is ignored, as in the ScanNet benchmark.
/// Average precision is the area under the precision-recall curve with precision made
/// non-increasing.
StandardScores standard_scores(std::span<const LabelledScene> scenes);

}  // namespace ovimap
