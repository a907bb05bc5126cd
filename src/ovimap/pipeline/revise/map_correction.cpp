// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/map_correction.h"

#include <algorithm>

#include "ovimap/base/error.h"
#include "ovimap/pipeline/mapping/kept_fusion.h"
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
  KeptFusion fusion(config, document.depth_camera);
  for (const auto& [position, kept] : document.kept_frames) {
    try {
      fusion.fuse(*kept, poses[position], map);
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
