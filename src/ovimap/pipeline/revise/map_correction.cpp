// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/map_correction.h"

#include <algorithm>

#include "ovimap/base/error.h"
#include "ovimap/map/fusion/free_space.h"
#include "ovimap/map/fusion/integrate.h"
#include "ovimap/pipeline/mapping/frame_store.h"
#include "ovimap/pipeline/sequence/map_description.h"

namespace ovimap {

namespace {

constexpr double kStill = 1e-6;  // metres and radians that text files lose

PoseCorrection compare(const std::vector<FrameLogEntry>& frames, const std::vector<Pose>& poses) {
  PoseCorrection correction;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Pose new_from_old = poses[i].inverse() * frames[i].world_from_camera;
    const double moved_m = new_from_old.translation().norm(),
                 turned_rad = Eigen::AngleAxisd(new_from_old.linear()).angle();
    correction.moved += moved_m > kStill || turned_rad > kStill;
    correction.furthest_m = std::max(correction.furthest_m, moved_m);
    correction.widest_rad = std::max(correction.widest_rad, turned_rad);
  }
  return correction;
}

/// The super-points that a frame's segments belong to by now.
std::vector<Label> roots_of(const std::vector<Label>& labels, const LabelForest& forest) {
  std::vector<Label> roots;
  for (const Label label : labels) roots.push_back(forest.root(label));
  return roots;
}

void fuse_again(const KeptFrame& kept, const PinholeCamera& camera, const Pose& world_from_camera,
                const MapperConfig& config, SeparateLooks& looks, VoxelMap& map) {
  const KeptImages images = decode_kept(kept, camera);
  const DepthSurface surface = fit_depth_surface(images.depth, camera, config.segment.surface);
  const std::vector<Label> labels = roots_of(kept.labels, map.labels());
  const DepthEstimate estimate =
      estimate_depth(images.depth, surface, config.segment.surface.noise, config.depth);
  const Observation observation{
      .depth = estimate.depth_m,
      .camera = camera,
      .world_from_camera = world_from_camera,
      .color = &images.color,
      .plane_slope = &surface.plane_slope,
      .sigma_m = estimate.sigma_m.empty() ? nullptr : &estimate.sigma_m,
      .segment_ids = labels.empty() ? nullptr : &images.segment_ids,
      .segment_labels = labels};
  if (looks.next(world_from_camera, config.free_space))
    clear_free_space(map, observation, config.free_space);
  integrate(map, observation);
}

}  // namespace

PoseCorrection correct_poses(MapDocument& document, const std::vector<Pose>& poses,
                             const MapperConfig& config,
                             const std::function<void(std::size_t, std::size_t)>& progress) {
  OVIMAP_ASSERT(poses.size() == document.frames.size());
  if (document.kept_frames.empty())
    throw Error(
        "the map keeps no frames to fuse again; map the recording with --set "
        "frame_store.max_mb=500, or map it anew with the corrected poses");
  if (!document.depth_camera.valid())
    throw Error("the map does not say which camera took its frames; map the recording anew with "
                "the corrected poses");
  PoseCorrection correction = compare(document.frames, poses);
  for (std::size_t i = 0; i < poses.size(); ++i) document.frames[i].world_from_camera = poses[i];
  VoxelMap map(document.map.config());
  map.labels() = document.map.labels();
  document.map = VoxelMap(map.config());
  SeparateLooks looks;
  for (const auto& [position, kept] : document.kept_frames) {
    try {
      fuse_again(*kept, document.depth_camera, poses[position], config, looks, map);
    } catch (const Error& fault) {
      throw Error(concat("the kept frame ", position, " cannot be fused again (", fault.what(),
                         "); map the recording anew with the corrected poses"));
    }
    if (progress) progress(++correction.refused, document.kept_frames.size());
  }
  correction.refused = document.kept_frames.size();
  document.map = std::move(map);
  InstanceRegistry registry(document.instance_config);
  registry.restore(InstanceRegistry::State(document.registry));
  describe_map(document.map, registry, config.summary, document);
  return correction;
}

}  // namespace ovimap
