// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/fusion/block_update.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "ovimap/base/vectorize.h"
#include "ovimap/map/fusion/projected_row.h"
#include "ovimap/map/voxels/label_slots.h"

namespace ovimap {

namespace {

// A sum with this number has its last bit at a step of a weight, up to weights of 4096.
constexpr float kWeightRounder = 12.f * kWeightSteps;
static_assert(kWeightSteps == 1024.f);
constexpr float kLeastColorShare = 1.f / 64.f;  ///< colours go on following the view
constexpr float kLeastSlope = 0.1f;  ///< surfaces seen at more than 84 degrees: a guess at best

static_assert(std::endian::native == std::endian::little);

/// What the frame says of them.
struct ObservedRow {
  Floats distance_m;  ///< to the surface, positive in front
  Floats weight;      ///< of the observation; 0: the voxel keeps what it has
  Floats sigma_m;     ///< of the depth; 0: unknown
  Ints observed;      ///< mask: the weight is not 0
};

/// Metres off the surface per metre of depth, at the pixels of `wanted` lanes.
OVIMAP_INLINE Floats slopes(const FusionView& view, const ProjectedRow& row, Ints wanted) {
  Floats slope = {};
  if (view.frame.plane_slope) slope = gather(view.frame.plane_slope->data(), row.pixel);
  const Ints unknown = slope <= 0.f;
  slope = larger(slope, broadcast(kLeastSlope));
  if (any(unknown & wanted))
    for (int i = 0; i < kLanes; ++i)
      if (unknown[i]) slope[i] = view.ray_length(row.pixel[i]);
  return slope;
}

/// What an observation's weight is the inverse of (Observation::sigma_m).
OVIMAP_INLINE Floats variance(const FusionView& view, Floats depth, Floats sigma_m) {
  if (!view.frame.sigma_m) return depth * depth;
  const Floats sigma = sigma_m * view.voxels_per_m;
  return sigma * sigma + FusionView::kLeastVariance;
}

/// Voxels on the observed surface: those that it may run through.
OVIMAP_INLINE Ints on_surface(const FusionView& view, const ObservedRow& seen) {
  return seen.observed &
         (magnitude(seen.distance_m) <= larger(broadcast(view.label_band_m), seen.sigma_m));
}

/// Distances and weights, in whole steps, falling to zero over the last voxels of the band
/// behind the surface, as many as there are from one voxel to the truncation; below half a step
/// they are 0. Returns whether any voxel is observed.
OVIMAP_INLINE bool observe(const FusionView& view, const ProjectedRow& row, ObservedRow& seen) {
  if (!any(row.inside)) return false;
  const Floats depth = gather(view.frame.depth.data(), row.pixel);
  const Floats in_front = depth - row.z_m;
  // Along the ray the distance is range / z times as long: both sides are squared, times z^2.
  seen.sigma_m = view.frame.sigma_m ? gather(view.frame.sigma_m->data(), row.pixel) : Floats{};
  const Floats band = larger(broadcast(view.truncation_m),
                             smaller(broadcast(kMostBand_m), kBandSigmas * seen.sigma_m));
  const Floats reach = row.z_m * band;
  const Ints near =
      row.inside & (depth > 0.f) & (in_front * in_front * row.range_squared < reach * reach);
  if (!any(near)) return false;
  seen.distance_m = in_front * slopes(view, row, near);
  const Floats falloff = smaller(broadcast(1.f), (seen.distance_m + band) * view.inverse_falloff);
  // Adding a number drops what lies below its last bit: the steps of a weight.
  const Floats weight = falloff / variance(view, depth, seen.sigma_m);
  const Floats rounded = weight + kWeightRounder - kWeightRounder;
  seen.observed = near & (rounded > 0.f);
  seen.weight = seen.observed ? rounded : Floats{};
  return any(seen.observed);
}

/// Running weighted mean of the distance; returns the share of the observation in the new value. A
/// weight of 0 leaves everything as it is.
OVIMAP_INLINE Floats blend_distance(const FusionView& view, const ObservedRow& seen,
                                    VoxelBlock::Tsdf* tsdf, float* weights) {
  const Floats sum = load(weights) + seen.weight;
  const Floats share = seen.observed ? seen.weight / sum : Floats{};
  const Floats old = load_integers(tsdf);
  const Floats target = smaller(broadcast(VoxelBlock::kTsdfScale), seen.distance_m * view.to_tsdf);
  const Floats mean = old + share * (larger(broadcast(-VoxelBlock::kTsdfScale), target) - old);
  // As VoxelBlock::stored_distance: what would be rounded to 0 is 1.
  store_integers(seen.observed & (magnitude(mean) < 0.5f) ? broadcast(1.f) : mean, tsdf);
  store(smaller(sum, broadcast(view.max_weight)), weights);
  return share;
}

/// Red, green and blue of a pixel in the low bytes of a word; what follows in memory above them.
OVIMAP_INLINE std::int32_t color_word(const RgbImage& image, std::int32_t pixel) {
  std::int32_t word = 0;
  // A copy of either size by one call would be a loop over bytes.
  if (static_cast<std::size_t>(pixel) + 1 == image.size()) [[unlikely]]  // nothing follows it
    std::memcpy(&word, image.data() + pixel, sizeof(Rgb8));
  else
    std::memcpy(&word, image.data() + pixel, sizeof(word));
  return word;
}

/// Rounds to the nearest step, so that with shares of 1/64 what differs by less than four levels
/// (blue: by eight) changes nothing any more.
OVIMAP_INLINE void blend_colors(const RgbImage& image, const ProjectedRow& row, Floats share,
                                PackedColor* colors) {
  const Ints& p = row.pixel;
  const Ints words = {color_word(image, p[0]), color_word(image, p[1]), color_word(image, p[2]),
                      color_word(image, p[3]), color_word(image, p[4]), color_word(image, p[5]),
                      color_word(image, p[6]), color_word(image, p[7])};
  Ints old;
  std::memcpy(&old, colors, sizeof(old));
  const Ints known = (words & 0xffffff) != 0;  // black is unknown
  const Floats mix = old == 0 ? broadcast(1.f) : larger(share, broadcast(kLeastColorShare));
  const Floats shares = (known & (share > 0.f)) ? mix : Floats{};
  Ints packed = {};
  for (std::size_t c = 0; c < kColorFields.size(); ++c) {
    const ColorField& field = kColorFields[c];
    const Floats was = __builtin_convertvector(
        old >> field.shift & static_cast<std::int32_t>(field.mask()), Floats);
    const Floats target =
        __builtin_convertvector(words >> static_cast<int>(8 * c) & 0xff, Floats) * field.steps();
    packed |= __builtin_convertvector(was + shares * (target - was) + 0.5f, Ints) << field.shift;
  }
  std::memcpy(colors, &packed, sizeof(packed));
}

/// Votes of a block's voxels for the labels of the segments they see.
class Voter {
 public:
  Voter(const FusionView& view, VoxelBlock& block) : view_(view), block_(block) {}

  OVIMAP_INLINE void vote(const ProjectedRow& row, const ObservedRow& seen, int first_voxel) {
    const Ints shown = on_surface(view_, seen);
    if (!any(shown)) return;
    for (int i = 0; i < kLanes; ++i)
      if (shown[i])
        vote((*view_.frame.segment_ids)[static_cast<std::size_t>(row.pixel[i])], first_voxel + i,
             view_.votes(row.z_m[i]));
  }

 private:
  void vote(std::uint16_t segment, int voxel, std::uint16_t votes) {
    if (segment == 0) return;
    if (segment != last_segment_) {  // neighbouring voxels mostly see the same segment
      last_segment_ = segment;
      const Label label = view_.frame.segment_labels[segment - 1u];
      position_ = label == kNoLabel ? 0 : palette_position(block_, label);
    }
    if (position_ != 0) add_support(block_, voxel, position_, votes);
  }

  const FusionView& view_;
  VoxelBlock& block_;
  std::uint16_t last_segment_ = 0;
  std::uint8_t position_ = 0;
};

}  // namespace

FusionView::FusionView(const VoxelMapConfig& config, const Observation& observation)
    : frame(observation),
      camera(observation.camera),
      truncation_m(config.truncation_m()),
      inverse_falloff(1.f / (truncation_m - config.voxel_size_m)),
      to_tsdf(VoxelBlock::kTsdfScale / truncation_m),
      max_weight(round_weight(config.max_weight)),
      label_band_m(config.label_band_voxels * config.voxel_size_m),
      voxels_per_m(1.f / config.voxel_size_m),
      voxel_size_m_(config.voxel_size_m),
      voxel_px_at_1m_(config.pixel_votes ? observation.camera.fx * config.voxel_size_m : 0.f) {
  const Pose camera_from_world = observation.world_from_camera.inverse();
  rotation_ = camera_from_world.linear();
  translation_ = camera_from_world.translation();
  voxel_steps = rotation_.cast<float>() * config.voxel_size_m;
}

std::uint16_t FusionView::votes(float depth_m) const {
  constexpr float kMost = 255.f;  // of 65535 that a slot holds
  return static_cast<std::uint16_t>(std::clamp(voxel_px_at_1m_ / depth_m + 0.5f, 1.f, kMost));
}

float FusionView::ray_length(int pixel) const {
  return camera
      .unproject(static_cast<float>(pixel % camera.width), static_cast<float>(pixel / camera.width),
                 1.f)
      .norm();
}

Eigen::Vector3f FusionView::block_origin(const BlockIndex& index) const {
  const Eigen::Vector3d first =
      (index.cast<double>() * kBlockSide + Eigen::Vector3d::Constant(0.5)) * voxel_size_m_;
  return (rotation_ * first + translation_).cast<float>();
}

namespace {

/// Calls `visit(first_voxel, row, seen)` for every row of the block in which the frame shows
/// something.
template <class Visit>
OVIMAP_INLINE void for_each_row(const FusionView& view, const VoxelBlock& block,
                                const Visit& visit) {
  const Eigen::Vector3f origin = view.block_origin(block.index);
  const Eigen::Matrix3f& steps = view.voxel_steps;
  ProjectedRow row;
  ObservedRow seen;
  for (int first = 0; first < kBlockVoxels; first += kBlockSide) {
    const float y = static_cast<float>(first / kBlockSide % kBlockSide),
                z = static_cast<float>(first / (kBlockSide * kBlockSide));
    project(view.camera, origin + steps.col(1) * y + steps.col(2) * z, steps, row);
    if (observe(view, row, seen)) visit(first, row, seen);
  }
}

/// What a frame ends on it does not see through.
OVIMAP_INLINE void end_doubts(const FusionView& view, const ObservedRow& seen,
                              std::uint8_t* doubts) {
  const Ints shown = on_surface(view, seen);
  if (!any(shown)) return;
  for (int i = 0; i < kLanes; ++i)
    if (shown[i]) doubts[i] = 0;
}

}  // namespace

OVIMAP_VECTORIZE void update_block(const FusionView& view, VoxelBlock& block) {
  Voter voter(view, block);
  for_each_row(view, block, [&](int first, const ProjectedRow& row, const ObservedRow& seen) {
    const Floats share =
        blend_distance(view, seen, block.tsdf.data() + first, block.weight.data() + first);
    if (view.frame.color) blend_colors(*view.frame.color, row, share, block.color.data() + first);
    if (view.frame.segment_ids) voter.vote(row, seen, first);
    if (!block.doubts.empty()) end_doubts(view, seen, block.doubts.data() + first);
    block.note_observed(static_cast<std::size_t>(first));
  });
}

OVIMAP_VECTORIZE void vote_in_block(const FusionView& view, VoxelBlock& block) {
  Voter voter(view, block);
  for_each_row(view, block, [&](int first, const ProjectedRow& row, const ObservedRow& seen) {
    voter.vote(row, seen, first);
  });
}

}  // namespace ovimap
