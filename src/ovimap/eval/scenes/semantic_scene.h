// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "ovimap/eval/scenes/labelled_scene.h"

namespace ovimap {

/// A labelled scene whose instances have classes. Classes are numbered 1..K by the caller, alike
/// in all scenes; any other number is no class (void).
struct SemanticScene {
  LabelledScene instances;
  std::vector<std::int32_t> truth_classes;  ///< per truth vertex; void vertices count for nothing
  std::map<std::uint32_t, std::int32_t> predicted_classes;  ///< of predicted instances; one that
                                                            ///< is not here has no class
};

/// The classes of an evaluation.
struct SemanticClasses {
  int count = 0;                    ///< K
  std::vector<std::int32_t> stuff;  ///< those that have no instances: walls, floor, ceiling
};

/// The classes of a scene's instances; positions are those of the overlap table they are made for.
struct InstanceClasses {
  std::vector<std::int32_t> truth, predicted;  ///< 0 = void, none
};

/// How a truth instance that touches several classes gets one.
enum class TruthClassRule {
  kMajority,  ///< that of most of its vertices, void included; of two the lower one
  kHighest,   ///< the highest number that it touches, as in the released code
};

struct InstanceOverlaps;

InstanceClasses instance_classes(const SemanticScene& scene, const InstanceOverlaps& table,
                                 int class_count, TruthClassRule rule);

/// The class at every truth vertex: of truth (void = 0) and of the predicted instance there.
struct VertexClasses {
  std::vector<std::int32_t> truth, predicted;
};
VertexClasses vertex_classes(const SemanticScene& scene, int class_count);

}  // namespace ovimap
