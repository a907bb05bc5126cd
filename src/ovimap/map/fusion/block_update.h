// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/map/fusion/integrate.h"

namespace ovimap {

/// Everything about a frame that is the same for all blocks.
class FusionView {
 public:
  /// Squared voxels. However sure a depth is, a voxel stands for what lies within half of one.
  static constexpr float kLeastVariance = 0.25f;

  FusionView(const VoxelMapConfig& config, const Observation& observation);

  /// Camera coordinates of a block's first voxel centre; in double, as maps may be far from the
  /// origin.
  Eigen::Vector3f block_origin(const BlockIndex& index) const;

  /// Length of a pixel's ray with unit depth.
  float ray_length(int pixel) const;
  /// What a voxel's vote for a label counts: the pixels along its side at that depth, at least one.
  std::uint16_t votes(float depth_m) const;

  const Observation& frame;
  const PinholeCamera& camera;
  float truncation_m, inverse_falloff, to_tsdf, max_weight, label_band_m, voxels_per_m;
  Eigen::Matrix3f voxel_steps;  ///< one voxel along x, y, z of the world, camera frame, metres

 private:
  double voxel_size_m_;
  float voxel_px_at_1m_;  ///< pixels along a voxel at a depth of one metre; 0: votes count as one
  Eigen::Matrix3d rotation_;
  Eigen::Vector3d translation_;
};

/// Fuses the frame into one block, whose labels are resolved.
void update_block(const FusionView& view, VoxelBlock& block);

/// Adds the label votes alone. The frame must have segments.
void vote_in_block(const FusionView& view, VoxelBlock& block);

}  // namespace ovimap
