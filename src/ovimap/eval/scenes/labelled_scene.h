// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace ovimap {

class ConfigFields;

/// What the class-agnostic protocols compare: two labellings of the same truth vertices.
struct LabelledScene {
  std::vector<std::int32_t> truth;       ///< instance id per truth vertex; 0 or less = unlabelled
  std::vector<std::uint32_t> predicted;  ///< id of the prediction at that vertex; 0 = none
  /// How sure the mapper is of each predicted instance; higher ranks first, an id that is not here
  /// last. Empty: an instance ranks by its number of vertices, as in the released code.
  std::map<std::uint32_t, float> confidence;
};

struct InstanceSize;

/// How a predicted instance ranks among others: its confidence, or its size where the scene has no
/// confidences.
double confidence_of(const LabelledScene& scene, const InstanceSize& instance);

struct TransferConfig {
  float radius_m = 0.05f;  ///< a truth vertex with no predicted vertex this near stays unlabelled
};
void list_fields(TransferConfig& config, ConfigFields& fields);

/// The label of the nearest predicted vertex within the radius for each truth vertex, else 0: what
/// the map missed stays in the evaluation as an error. `predicted_labels` is as long as
/// `predicted_points`. Returns one label per truth point.
std::vector<std::uint32_t> transfer_labels(std::span<const Eigen::Vector3f> truth_points,
                                           std::span<const Eigen::Vector3f> predicted_points,
                                           std::span<const std::uint32_t> predicted_labels,
                                           const TransferConfig& config = {});

}  // namespace ovimap
