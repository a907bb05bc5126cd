// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "ovimap/eval/scenes/semantic_scene.h"

namespace ovimap::fixture {

/// Appends `count` vertices of one truth instance and class and one predicted instance.
inline void add(SemanticScene& scene, int count, std::int32_t truth, std::int32_t truth_class,
                std::uint32_t predicted) {
  const auto n = static_cast<std::size_t>(count);
  scene.instances.truth.insert(scene.instances.truth.end(), n, truth);
  scene.instances.predicted.insert(scene.instances.predicted.end(), n, predicted);
  scene.truth_classes.insert(scene.truth_classes.end(), n, truth_class);
}

/// Instances 1..12 of classes 0..4 and predictions that mostly agree; confidences all differ.
inline SemanticScene random_semantic_scene(unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  SemanticScene scene;
  for (std::int32_t truth = 0; truth <= 12; ++truth)
    for (int part = 0; part < 4; ++part) {
      const auto predicted = static_cast<std::uint32_t>(part < 2 ? truth + 1 : draw(0, 14));
      add(scene, draw(5, 160), truth, truth % 5, predicted);
    }
  for (std::uint32_t id = 1; id <= 14; ++id) {
    const std::int32_t right = (static_cast<std::int32_t>(id) + 4) % 5;
    scene.predicted_classes[id] = draw(0, 3) > 0 ? right : draw(0, 4);
    scene.instances.confidence[id] = static_cast<float>(id) / 100 +
                                     static_cast<float>(draw(0, 900)) +
                                     static_cast<float>(seed) / 4096;
  }
  return scene;
}

/// The same scene with its vertices in another order.
inline SemanticScene shuffled(const SemanticScene& scene, unsigned seed) {
  std::vector<std::size_t> order(scene.truth_classes.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(seed));
  SemanticScene result = scene;
  for (std::size_t v = 0; v < order.size(); ++v) {
    result.instances.truth[v] = scene.instances.truth[order[v]];
    result.instances.predicted[v] = scene.instances.predicted[order[v]];
    result.truth_classes[v] = scene.truth_classes[order[v]];
  }
  return result;
}

}  // namespace ovimap::fixture
