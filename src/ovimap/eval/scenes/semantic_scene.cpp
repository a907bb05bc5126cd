// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scenes/semantic_scene.h"

#include <algorithm>

#include "ovimap/base/error.h"
#include "ovimap/eval/scenes/overlap.h"

namespace ovimap {

namespace {

std::int32_t class_or_void(std::int32_t number, int class_count) {
  return number >= 1 && number <= class_count ? number : 0;
}

std::int32_t predicted_class(const SemanticScene& scene, std::int64_t id, int class_count) {
  const auto found = scene.predicted_classes.find(static_cast<std::uint32_t>(id));
  return found == scene.predicted_classes.end() ? 0 : class_or_void(found->second, class_count);
}

/// How many vertices of each class an instance has.
using ClassCounts = std::map<std::int32_t, std::int64_t>;

std::int32_t chosen_class(const ClassCounts& counts, TruthClassRule rule) {
  if (rule == TruthClassRule::kHighest) return counts.rbegin()->first;
  return std::max_element(counts.begin(), counts.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

}  // namespace

InstanceClasses instance_classes(const SemanticScene& scene, const InstanceOverlaps& table,
                                 int class_count, TruthClassRule rule) {
  const std::vector<std::int32_t>& ids = scene.instances.truth;
  OVIMAP_ASSERT(ids.size() == scene.truth_classes.size());
  std::map<std::int64_t, ClassCounts> counts;
  for (std::size_t v = 0; v < ids.size(); ++v)
    ++counts[ids[v]][class_or_void(scene.truth_classes[v], class_count)];
  InstanceClasses classes;
  for (const InstanceSize& instance : table.truth)
    classes.truth.push_back(chosen_class(counts.at(instance.id), rule));
  for (const InstanceSize& instance : table.predicted)
    classes.predicted.push_back(predicted_class(scene, instance.id, class_count));
  return classes;
}

VertexClasses vertex_classes(const SemanticScene& scene, int class_count) {
  const std::size_t count = scene.truth_classes.size();
  OVIMAP_ASSERT(scene.instances.predicted.size() == count);
  VertexClasses classes{std::vector<std::int32_t>(count), std::vector<std::int32_t>(count)};
  std::uint32_t last_id = 0;  // neighbouring vertices mostly share their instance
  std::int32_t last_class = 0;
  for (std::size_t v = 0; v < count; ++v) {
    classes.truth[v] = class_or_void(scene.truth_classes[v], class_count);
    if (const std::uint32_t id = scene.instances.predicted[v]; id != last_id) {
      last_id = id;
      last_class = id == 0 ? 0 : predicted_class(scene, id, class_count);
    }
    classes.predicted[v] = last_class;
  }
  return classes;
}

}  // namespace ovimap
