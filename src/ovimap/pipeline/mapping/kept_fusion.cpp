// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/kept_fusion.h"

#include "ovimap/map/fusion/integrate.h"

namespace ovimap {

namespace {

/// The super-points that a frame's segments belong to by now.
std::vector<Label> roots_of(const std::vector<Label>& labels, const LabelForest& forest) {
  std::vector<Label> roots;
  for (const Label label : labels) roots.push_back(forest.root(label));
  return roots;
}

}  // namespace

PreparedKept::PreparedKept(const KeptFrame& kept, const MapperConfig& config,
                           const PinholeCamera& camera)
    : images(decode_kept(kept, camera)),
      surface(fit_depth_surface(images.depth, camera, config.segment.surface)),
      estimate(estimate_depth(images.depth, surface, config.segment.surface.noise, config.depth)) {}

std::vector<std::uint32_t> KeptFusion::fuse(const KeptFrame& kept, const Pose& world_from_camera,
                                            VoxelMap& map, const BlockChoice* blocks) {
  const PreparedKept frame(kept, config_, camera_);
  const std::vector<Label> labels = roots_of(kept.labels, map.labels());
  const Observation observation{
      .depth = frame.estimate.depth_m,
      .camera = camera_,
      .world_from_camera = world_from_camera,
      .color = &frame.images.color,
      .plane_slope = &frame.surface.plane_slope,
      .sigma_m = frame.estimate.sigma_m.empty() ? nullptr : &frame.estimate.sigma_m,
      .segment_ids = labels.empty() ? nullptr : &frame.images.segment_ids,
      .segment_labels = labels,
      .blocks = blocks};
  std::vector<std::uint32_t> slots;
  if (looks_.next(world_from_camera, config_.free_space))
    slots = clear_free_space(map, observation, config_.free_space).slots;
  const std::vector<std::uint32_t> filled = integrate(map, observation);
  slots.insert(slots.end(), filled.begin(), filled.end());
  return slots;
}

}  // namespace ovimap
