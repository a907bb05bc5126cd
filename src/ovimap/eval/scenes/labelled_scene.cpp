// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scenes/labelled_scene.h"

#include <limits>

#include "ovimap/base/config.h"
#include "ovimap/eval/geometry/nearest.h"
#include "ovimap/eval/scenes/overlap.h"

namespace ovimap {

double confidence_of(const LabelledScene& scene, const InstanceSize& instance) {
  if (scene.confidence.empty()) return static_cast<double>(instance.vertices);
  const auto found = scene.confidence.find(static_cast<std::uint32_t>(instance.id));
  return found == scene.confidence.end() ? std::numeric_limits<double>::lowest()
                                         : double{found->second};
}

void list_fields(TransferConfig& config, ConfigFields& fields) {
  fields.add("radius_m", config.radius_m, 0.001f, 1.f,
             "how near a predicted vertex must be to label a truth vertex, in metres");
}

std::vector<std::uint32_t> transfer_labels(std::span<const Eigen::Vector3f> truth_points,
                                           std::span<const Eigen::Vector3f> predicted_points,
                                           std::span<const std::uint32_t> predicted_labels,
                                           const TransferConfig& config) {
  OVIMAP_ASSERT(predicted_points.size() == predicted_labels.size());
  const NearestPoints predicted(predicted_points);
  const auto neighbors = predicted.find_all(truth_points, config.radius_m);
  std::vector<std::uint32_t> labels(truth_points.size(), 0);
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (neighbors[i]) labels[i] = predicted_labels[neighbors[i]->index];
  return labels;
}

}  // namespace ovimap
