// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/kept_fusion.h"

#include "ovimap/map/fusion/integrate.h"
#include "ovimap/pipeline/mapping/frame_store.h"

namespace ovimap {

namespace {

/// The super-points that a frame's segments belong to by now.
std::vector<Label> roots_of(const std::vector<Label>& labels, const LabelForest& forest) {
  std::vector<Label> roots;
  for (const Label label : labels) roots.push_back(forest.root(label));
  return roots;
}

}  // namespace

void KeptFusion::fuse(const KeptFrame& kept, const Pose& world_from_camera, VoxelMap& map) {
  const KeptImages images = decode_kept(kept, camera_);
  const DepthSurface surface = fit_depth_surface(images.depth, camera_, config_.segment.surface);
  const std::vector<Label> labels = roots_of(kept.labels, map.labels());
  const DepthEstimate estimate =
      estimate_depth(images.depth, surface, config_.segment.surface.noise, config_.depth);
  const Observation observation{
      .depth = estimate.depth_m,
      .camera = camera_,
      .world_from_camera = world_from_camera,
      .color = &images.color,
      .plane_slope = &surface.plane_slope,
      .sigma_m = estimate.sigma_m.empty() ? nullptr : &estimate.sigma_m,
      .segment_ids = labels.empty() ? nullptr : &images.segment_ids,
      .segment_labels = labels};
  if (looks_.next(world_from_camera, config_.free_space))
    clear_free_space(map, observation, config_.free_space);
  integrate(map, observation);
}

}  // namespace ovimap
