// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/pipeline/mapping/mapper.h"
#include "ovimap/track/graph/moved_poses.h"

namespace ovimap {

/// Where a camera was at some moments of its way, as whoever closes loops says by now.
struct PoseUpdate {
  struct Node {
    double at = 0;  ///< a frame's index in the map, or a time in seconds (by_time)
    Pose world_from_camera = Pose::Identity();  ///< of the depth camera
  };
  bool by_time = false;
  std::vector<Node> nodes;
};

/// What the nodes say of frames in the map, in order: a node between two frames is held against the
/// pose between theirs. Nodes before the first and after the last frame say nothing.
std::vector<MovedPose> moves_of(const PoseUpdate& update, const std::vector<FrameLogEntry>& frames);

/// Moves the frames of a log as `moves` says, whose `at` are indices or times, and the map with
/// them (Mapper::fuse_again, with `progress`). `moves` may not be empty.
FusedAgain move_frames(const std::vector<MovedPose>& moves, bool by_time, Mapper& mapper,
                       std::vector<FrameLogEntry>& frames, const PinholeCamera& depth_camera,
                       const std::function<void(std::size_t, std::size_t)>& progress = nullptr);

}  // namespace ovimap
