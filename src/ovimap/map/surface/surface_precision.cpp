// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/surface/surface_precision.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ovimap/base/median.h"

namespace ovimap {

namespace {

constexpr float kStepsPerMetre = 5000.f;

}  // namespace

std::optional<float> surface_error_m(const VoxelMap& map, const VoxelBlock& block) {
  const float voxel_m = map.config().voxel_size_m;
  std::vector<float> weights;
  for (int voxel = 0; voxel < kBlockVoxels; ++voxel) {
    const float weight = block.weight[static_cast<std::size_t>(voxel)];
    if (weight < map.config().min_mesh_weight || weight <= 0.f) continue;
    if (std::fabs(map.distance_m(block, voxel)) < voxel_m) weights.push_back(weight);
  }
  if (weights.empty()) return std::nullopt;
  return voxel_m / std::sqrt(median_of(weights));
}

std::uint8_t error_byte(std::optional<float> error_m) {
  if (!error_m) return 0;
  return static_cast<std::uint8_t>(std::lround(std::clamp(*error_m * kStepsPerMetre, 1.f, 255.f)));
}

float error_of_byte(std::uint8_t byte) {
  return static_cast<float>(byte) / kStepsPerMetre;
}

}  // namespace ovimap
