// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/map_correction.h"

#include <algorithm>

#include "ovimap/base/error.h"
#include "ovimap/pipeline/mapping/moved_fusion.h"
#include "ovimap/pipeline/sequence/map_description.h"
#include "ovimap/pipeline/sequence/sequence_run.h"

namespace ovimap {

namespace {

constexpr double kStill = 1e-6;  // metres and radians that text files lose

PoseCorrection compare(const PoseChange& change) {
  PoseCorrection correction;
  for (std::size_t i = 0; i < change.moved.size(); ++i) {
    const Pose new_from_old = change.after[i].inverse() * change.before[i];
    correction.moved += change.moved[i];
    correction.furthest_m = std::max(correction.furthest_m, new_from_old.translation().norm());
    correction.widest_rad =
        std::max(correction.widest_rad, Eigen::AngleAxisd(new_from_old.linear()).angle());
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
    throw Error(
        "the map does not say which camera took its frames; map the recording anew with "
        "the corrected poses");
  const PoseChange change = change_of(poses_of(document.frames), poses, kStill, 1.);
  PoseCorrection correction = compare(change);
  for (std::size_t i = 0; i < poses.size(); ++i)
    document.frames[i].world_from_camera = change.after[i];
  document.live_steps.clear();  // which would make the map as it was
  document.seen_free.clear();   // by the old poses
  document.movers.clear();
  const FusedAgain done = fuse_moved(document.map, document.kept_frames, change, config,
                                     document.depth_camera, progress);
  correction.refused = done.frames;
  correction.blocks = done.slots.size();
  InstanceRegistry registry(document.instance_config);
  registry.restore(InstanceRegistry::State(document.registry));
  describe_map(document.map, registry, config.summary, document);
  return correction;
}

}  // namespace ovimap
