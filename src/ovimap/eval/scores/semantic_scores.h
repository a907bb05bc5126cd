// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ovimap/eval/scenes/semantic_scene.h"

namespace ovimap {

class ConfigFields;

struct SemanticReferenceConfig {
  int min_vertices = 100;  ///< truth and predicted instances with fewer vertices do not count
};
void list_fields(SemanticReferenceConfig& config, ConfigFields& fields);

/// The figures of one class. Those that have no meaning are absent: IoU and accuracy where no truth
/// vertex has the class, precision where no counted truth instance has, quality where neither side
/// has a segment (and in the reference protocol, which does not know it).
struct ClassScores {
  std::int32_t class_number = 0;
  std::int64_t truth_vertices = 0, predicted_vertices = 0;  ///< where the truth has a class
  std::optional<double> iou, accuracy;
  std::optional<double> ap25, ap50, ap75, ap;
  std::optional<double> pq, sq, rq;
};

/// Means over the classes that have the figure, all in [0, 1]; 0 when none has.
struct SemanticScores {
  double miou = 0, macc = 0;
  double fwiou = 0;  ///< IoU weighted by the truth vertices of the class
  double ap25 = 0, ap50 = 0, ap75 = 0, ap = 0;
  double pq = 0, sq = 0, rq = 0;
  int classes = 0;           ///< that occur in the truth
  int instance_classes = 0;  ///< whose instances are scored
};

/// Figures of every class, in order of their numbers, from all scenes pooled; `standard` protocol.
/// IoU and accuracy come from one confusion matrix of vertices over all scenes: what is void in the
/// truth is left out, what has no predicted class is missed. Average precision is ranked_precision
/// of the class's instances over all truth ids, with ap its mean over IoU 0.50, 0.55 ... 0.95;
/// predictions rank by confidence, else by size, and are excused on void truth.
std::vector<ClassScores> standard_class_scores(std::span<const SemanticScene> scenes,
                                               const SemanticClasses& classes);

/// The same as the paper's released code has it. Confusion as above. Average precision is
/// benchmark_precision over the classes that are no stuff, with ap its mean over 0.50 ... 0.90; a
/// prediction's confidence is its size over that of the scene's largest of its class; the lowest
/// truth id of a scene is dropped, whatever it is; an instance has the highest class it touches;
/// void is where the truth has no class or stuff. Instances with too few views are the caller's to
/// drop (without_instances).
std::vector<ClassScores> reference_class_scores(std::span<const SemanticScene> scenes,
                                                const SemanticClasses& classes,
                                                const SemanticReferenceConfig& config = {});

/// Means over classes: all of them, or a group such as head, common or tail.
SemanticScores mean_scores(std::span<const ClassScores> classes);
SemanticScores mean_scores(std::span<const ClassScores> classes,
                           std::span<const std::int32_t> group);

/// The scene with the vertices of some predicted instances unlabelled.
LabelledScene without_instances(LabelledScene scene, std::span<const std::uint32_t> dropped);

}  // namespace ovimap
