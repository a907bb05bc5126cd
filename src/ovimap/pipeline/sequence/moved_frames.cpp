// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/moved_frames.h"

#include <algorithm>

namespace ovimap {

namespace {

double taken_at(const FrameLogEntry& frame, bool by_time) {
  return by_time ? frame.timestamp_s : static_cast<double>(frame.index);
}

}  // namespace

std::vector<MovedPose> moves_of(const PoseUpdate& update,
                                const std::vector<FrameLogEntry>& frames) {
  std::vector<MovedPose> moves;
  for (const PoseUpdate::Node& node : update.nodes) {
    const auto next = std::find_if(frames.begin(), frames.end(), [&](const FrameLogEntry& frame) {
      return taken_at(frame, update.by_time) >= node.at;
    });
    if (next == frames.end()) continue;
    const double after = taken_at(*next, update.by_time);
    if (next == frames.begin() && after > node.at) continue;
    const FrameLogEntry& last = next == frames.begin() ? *next : *std::prev(next);
    const double before = taken_at(last, update.by_time);
    const double share = after > before ? (node.at - before) / (after - before) : 1;
    moves.push_back({node.at, pose_between(last.world_from_camera, next->world_from_camera, share),
                     node.world_from_camera});
  }
  std::stable_sort(moves.begin(), moves.end(),
                   [](const MovedPose& a, const MovedPose& b) { return a.at < b.at; });
  return moves;
}

FusedAgain move_frames(const std::vector<MovedPose>& moves, bool by_time, Mapper& mapper,
                       std::vector<FrameLogEntry>& frames, const PinholeCamera& depth_camera,
                       const std::function<void(std::size_t, std::size_t)>& progress) {
  std::vector<Pose> poses;
  std::vector<double> at;
  for (const FrameLogEntry& frame : frames) {
    poses.push_back(frame.world_from_camera);
    at.push_back(taken_at(frame, by_time));
  }
  poses = follow(poses, at, moves);
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].world_from_camera = poses[i];
  return mapper.fuse_again(poses, depth_camera, progress);
}

}  // namespace ovimap
