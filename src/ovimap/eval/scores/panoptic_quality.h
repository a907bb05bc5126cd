// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "ovimap/eval/scenes/semantic_scene.h"

namespace ovimap {

/// Matched and unmatched segments of one class.
struct PanopticCounts {
  int right = 0, wrong = 0, missed = 0;
  double iou_sum = 0;  ///< of the right ones

  int segments() const { return right + wrong + missed; }
  double segmentation_quality() const;  ///< SQ; 0 when nothing is right
  double recognition_quality() const;   ///< RQ; 0 without segments
  double quality() const { return segmentation_quality() * recognition_quality(); }  ///< PQ
};

/// Panoptic quality (Kirillov et al., CVPR 2019), summed over the scenes: element c - 1 belongs to
/// class c. Of a stuff class all vertices of a scene are one segment, of any other each instance is
/// one. Void truth (no class, or a class with instances but no instance there) is taken out of the
/// predictions before matching; a pair matches when it has the same class and an IoU above 0.5; an
/// unmatched prediction that lies mostly on void truth is no error.
std::vector<PanopticCounts> panoptic_counts(std::span<const SemanticScene> scenes,
                                            const SemanticClasses& classes);

}  // namespace ovimap
