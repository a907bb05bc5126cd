// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "ovimap/eval/scenes/labelled_scene.h"

namespace ovimap {

struct ReferenceProtocolConfig {
  int min_vertices = 10;  ///< smaller truth and predicted instances do not count
};
void list_fields(ReferenceProtocolConfig& config, ConfigFields& fields);

/// Class-agnostic figures as the paper's released code computes them, to stand beside its tables.
/// They are no ranked average precision: a prediction is right when its best IoU reaches the
/// threshold, even when another one matched the same truth instance, so a recall may exceed 1.
struct ReferenceScores {
  double miou = 0;  ///< mean over counted truth instances of the best IoU with any prediction
  double wiou = 0;  ///< the same, weighted by the vertices of the truth instance
  double ap25 = 0, ap50 = 0, ap75 = 0;              ///< right / counted predictions ("mP@t")
  double recall25 = 0, recall50 = 0, recall75 = 0;  ///< right predictions / counted truth ("mR@t")
  int truth_instances = 0, predicted_instances = 0;
};

struct ReferenceSummary {
  ReferenceScores
      scene_mean;          ///< mean of each figure over the scenes that have truth; counts summed
  ReferenceScores pooled;  ///< from the sums over all scenes
};

/// The lowest truth id that occurs in a scene is dropped, whatever it is: the released code
/// re-indexes ids by sorted order and takes index 0 for background. Vertices of dropped instances
/// still count in the sizes of predictions. A figure whose denominator is zero is 0.
ReferenceSummary reference_summary(std::span<const LabelledScene> scenes,
                                   const ReferenceProtocolConfig& config = {});

}  // namespace ovimap
