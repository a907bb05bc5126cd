// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/map_loops.h"

#include "ovimap/pipeline/mapping/frame_store.h"
#include "ovimap/track/graph/moved_poses.h"

namespace ovimap {

namespace {

Frame frame_of(const KeptFrame& kept, const PinholeCamera& camera) {
  KeptImages images = decode_kept(kept, camera);
  Frame frame;
  frame.depth = std::move(images.depth);
  frame.color = std::move(images.color);
  frame.depth_camera = frame.color_camera = camera;
  return frame;
}

}  // namespace

std::vector<Keyframe> keyframes_of(const MapDocument& map, const KeyframeSpacing& spacing) {
  std::vector<Keyframe> keyframes;
  for (const auto& [position, kept] : map.kept_frames) {
    const FrameLogEntry& entry = map.frames[position];
    if (!keyframes.empty() &&
        !spacing.far(keyframes.back().world_from_camera, entry.world_from_camera))
      continue;
    keyframes.push_back(make_keyframe(make_pyramid(frame_of(*kept, map.depth_camera)), entry.index,
                                      entry.world_from_camera));
  }
  return keyframes;
}

LoopReport close_map_loops(MapDocument& map, const MapperConfig& mapper, const TrackConfig& track,
                           const LoopConfig& loops,
                           const std::function<void(std::size_t, std::size_t)>& progress) {
  const std::vector<Keyframe> keyframes = keyframes_of(map, track.keyframes);
  const LoopClosure closure = close_loops(keyframes, track, loops);
  LoopReport report{keyframes.size(), closure.candidates, closure.closed,
                    closure.dropped,  closure.furthest_m, std::nullopt};
  if (closure.closed == 0 || closure.furthest_m < map.map.config().voxel_size_m / 2) return report;
  std::vector<Pose> poses;
  std::vector<double> at;
  for (const FrameLogEntry& frame : map.frames) {
    poses.push_back(frame.world_from_camera);
    at.push_back(static_cast<double>(frame.index));
  }
  report.correction = correct_poses(
      map, follow(poses, at, moved_keyframes(keyframes, closure.poses)), mapper, progress);
  return report;
}

}  // namespace ovimap
