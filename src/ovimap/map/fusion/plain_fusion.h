// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "ovimap/map/fusion/block_update.h"
#include "ovimap/map/voxels/label_slots.h"

namespace ovimap::plain {

/// Fusion written voxel by voxel, as plainly as possible: what `integrate` must equal to the bit,
/// and what bench/micro measures it against.
class VoxelFusion {
 public:
  VoxelFusion(const FusionView& view, VoxelBlock& block) : view_(view), block_(block) {}

  void fuse() {
    const Eigen::Vector3f origin = view_.block_origin(block_.index);
    for (int v = 0; v < kBlockVoxels; ++v) {
      const float x = static_cast<float>(v & 7), y = static_cast<float>(v >> 3 & 7),
                  z = static_cast<float>(v >> 6);
      const Eigen::Vector3f start =
          origin + view_.voxel_steps.col(1) * y + view_.voxel_steps.col(2) * z;
      fuse_voxel(static_cast<std::size_t>(v), start + view_.voxel_steps.col(0) * x);
    }
  }

 private:
  int pixel_of(const Eigen::Vector3f& point) const {
    const PinholeCamera& camera = view_.camera;
    const float inverse = 1.f / std::max(point.z(), 1e-6f);
    const float u = camera.fx * (point.x() * inverse) + (camera.cx + 0.5f);
    const float v = camera.fy * (point.y() * inverse) + (camera.cy + 0.5f);
    if (point.z() <= 1e-3f || u < 0.f || v < 0.f || u >= static_cast<float>(camera.width) ||
        v >= static_cast<float>(camera.height))
      return -1;
    return static_cast<int>(v) * camera.width + static_cast<int>(u);
  }

  float slope(std::size_t pixel) const {
    const float fitted = view_.frame.plane_slope ? (*view_.frame.plane_slope)[pixel] : 0.f;
    return fitted > 0.f ? std::max(fitted, 0.1f) : view_.ray_length(static_cast<int>(pixel));
  }

  float sigma_m(std::size_t pixel) const {
    return view_.frame.sigma_m ? (*view_.frame.sigma_m)[pixel] : 0.f;
  }

  float variance(std::size_t pixel) const {
    const float depth = view_.frame.depth[pixel];
    if (!view_.frame.sigma_m) return depth * depth;
    const float sigma = sigma_m(pixel) * view_.voxels_per_m;
    return sigma * sigma + FusionView::kLeastVariance;
  }

  void fuse_voxel(std::size_t voxel, const Eigen::Vector3f& point) {
    const int index = pixel_of(point);
    if (index < 0) return;
    const auto pixel = static_cast<std::size_t>(index);
    const float depth = view_.frame.depth[pixel], in_front = depth - point.z();
    const float range_squared =
        point.x() * point.x() + point.y() * point.y() + point.z() * point.z();
    const float band =
        std::max(view_.truncation_m, std::min(kMostBand_m, kBandSigmas * sigma_m(pixel)));
    const float reach = point.z() * band;
    if (depth <= 0.f || in_front * in_front * range_squared >= reach * reach) return;
    const float distance = in_front * slope(pixel);
    const float falloff = std::min(1.f, (distance + band) * view_.inverse_falloff);
    const float weight = std::nearbyint(falloff / variance(pixel) * kWeightSteps) / kWeightSteps;
    if (weight <= 0.f) return;
    const float sum = block_.weight[voxel] + weight, share = weight / sum;
    constexpr float kMost = VoxelBlock::kTsdfScale;
    const float target = std::clamp(distance * view_.to_tsdf, -kMost, kMost);
    const float old = block_.tsdf[voxel];
    block_.tsdf[voxel] = VoxelBlock::stored_distance(rounded(old + share * (target - old)));
    block_.weight[voxel] = std::min(sum, view_.max_weight);
    block_.note_observed(voxel);
    if (view_.frame.color) blend_color(voxel, (*view_.frame.color)[pixel], share);
    if (std::fabs(distance) > std::max(view_.label_band_m, sigma_m(pixel))) return;
    if (view_.frame.segment_ids) vote(voxel, (*view_.frame.segment_ids)[pixel], point.z());
    if (!block_.doubts.empty()) block_.doubts[voxel] = 0;
  }

  static int rounded(float value) { return static_cast<int>(value + (value < 0.f ? -0.5f : 0.5f)); }

  void blend_color(std::size_t voxel, const Rgb8& color, float share) {
    if (color == Rgb8{}) return;  // unknown
    const PackedColor old = block_.color[voxel];
    const float mix = old == 0 ? 1.f : std::max(share, 1.f / 64.f);
    const std::uint8_t channels[3] = {color.r, color.g, color.b};
    block_.color[voxel] = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const ColorField& field = kColorFields[c];
      const auto was = static_cast<float>(old >> field.shift & field.mask());
      const float target = static_cast<float>(channels[c]) * field.steps();
      const auto steps = static_cast<PackedColor>(rounded(was + mix * (target - was)));
      block_.color[voxel] |= steps << field.shift;
    }
  }

  void vote(std::size_t voxel, std::uint16_t segment, float depth_m) {
    if (segment == 0) return;
    const Label label = view_.frame.segment_labels[segment - 1u];
    if (label == kNoLabel) return;
    if (const std::uint8_t position = palette_position(block_, label))
      add_support(block_, static_cast<int>(voxel), position, view_.votes(depth_m));
  }

  const FusionView& view_;
  VoxelBlock& block_;
};

inline void integrate(VoxelMap& map, const Observation& observation) {
  const FusionView view(map.config(), observation);
  for (const std::uint32_t slot : allocate_blocks(map, observation)) {
    resolve_labels(map.writable_block(slot), map.labels());
    VoxelFusion(view, map.writable_block(slot)).fuse();
  }
}

}  // namespace ovimap::plain
