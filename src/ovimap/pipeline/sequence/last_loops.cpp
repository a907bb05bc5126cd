// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/last_loops.h"

#include "ovimap/pipeline/mapping/frame_store.h"
#include "ovimap/pipeline/sequence/moved_frames.h"

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

std::vector<Keyframe> keyframes_of(const std::vector<FrameLogEntry>& frames, const KeptFrames& kept,
                                   const PinholeCamera& depth_camera,
                                   const KeyframeSpacing& spacing) {
  std::vector<Keyframe> keyframes;
  for (const auto& [position, images] : kept) {
    const FrameLogEntry& entry = frames[position];
    if (!keyframes.empty() &&
        !spacing.far(keyframes.back().world_from_camera, entry.world_from_camera))
      continue;
    keyframes.push_back(make_keyframe(make_pyramid(frame_of(*images, depth_camera)), entry.index,
                                      entry.world_from_camera));
  }
  return keyframes;
}

LoopReport close_last_loops(Mapper& mapper, std::vector<FrameLogEntry>& frames,
                            const PinholeCamera& depth_camera, const TrackConfig& track,
                            const LoopConfig& loops,
                            const std::function<void(std::size_t, std::size_t)>& progress) {
  std::vector<Keyframe> keyframes;
  LoopClosure closure;
  {
    auto t = mapper.timers().measure("last_loops");
    keyframes = keyframes_of(frames, mapper.kept_frames(), depth_camera, track.keyframes);
    closure = close_loops(keyframes, track, loops);
  }
  LoopReport report{keyframes.size(), closure.candidates, closure.closed,
                    closure.dropped,  closure.furthest_m, 0};
  if (closure.closed == 0 || closure.furthest_m < mapper.config().map.voxel_size_m / 2)
    return report;
  const FusedAgain done = move_frames(moved_keyframes(keyframes, closure.poses), false, mapper,
                                      frames, depth_camera, progress);
  report.fused_share =
      static_cast<double>(done.slots.size()) / static_cast<double>(mapper.map().block_count());
  return report;
}

}  // namespace ovimap
