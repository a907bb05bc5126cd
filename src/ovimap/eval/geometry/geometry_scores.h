// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/geometry/mesh.h"

namespace ovimap {

class ConfigFields;

struct GeometryScoresConfig {
  float accuracy_limit_m = 0.2f;  ///< predicted vertices farther from the truth are counted apart
  float completeness_m = 0.05f;   ///< how near a predicted vertex must be
  float fine_completeness_m = 0.01f;  ///< how near the predicted surface must be
};
void list_fields(GeometryScoresConfig& config, ConfigFields& fields);

/// How well a predicted surface fits the true one. Where no predicted vertex lies within the limit,
/// the accuracies are the limit and the shares 0.
struct GeometryScores {
  double accuracy_m = 0;         ///< mean distance from predicted vertices to the true surface
  double accuracy_median_m = 0;  ///< the median of the same (the lower one of an even number)
  double stray = 0;              ///< share of predicted vertices beyond the limit, left out of both
  double completeness = 0;       ///< share of truth vertices with a predicted vertex near
  double fine_completeness = 0;  ///< share of truth vertices with the predicted surface very near
};

/// Distances are from points to triangles, so that millimetres mean something: between two vertex
/// sets a perfect map would already be off by half a voxel. Both meshes are in the world frame.
GeometryScores geometry_scores(const Mesh& truth, const Mesh& predicted,
                               const GeometryScoresConfig& config = {});

}  // namespace ovimap
