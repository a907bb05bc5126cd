// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "ovimap/pipeline/mapping/kept_fusion.h"

namespace ovimap {

/// Where the frames of a map were fused from, and where they are to be fused from
/// (world_from_camera of the depth camera).
struct PoseChange {
  std::vector<Pose> before, after;
  std::vector<std::uint8_t> moved;  ///< by frame; `after` is `before` of those that did not
};

/// What poses that are known better change. Frames stay where they were fused that are no farther
/// from it than `still_m`, measured on a point `at_m` ahead of the camera.
PoseChange change_of(std::vector<Pose> fused_from, const std::vector<Pose>& poses, double still_m,
                     double at_m);

/// What became of a map whose frames moved.
struct FusedAgain {
  std::size_t moved = 0;   ///< frames
  std::size_t frames = 0;  ///< kept frames that were fused again: those, and what shows the same
  std::vector<std::uint32_t> slots;  ///< of the blocks that were made anew, in block-index order
  SeparateLooks looks;               ///< of all kept frames
};

/// Makes anew, from the kept frames in order, the blocks that a moved frame may have changed from
/// where it was or may change from where it is; every other block keeps what it has, bit for bit.
/// Blocks stay, if empty, and so do labels. What it makes is what fusing all kept frames into the
/// emptied map would make there, but for one thing: whether a frame that did not move contradicts
/// more of the map than it confirms (clear_free_space) is asked of the other blocks as they are by
/// now, not as they were then. Of a moved frame that is not kept, all is taken to have changed that
/// it may have seen as far as the kept frame before it saw.
///
/// A map with a store stays within its bound. `progress(done, total)`: after each kept frame.
/// Throws Error when a kept frame is damaged.
FusedAgain fuse_moved(VoxelMap& map, const KeptFrames& kept, const PoseChange& change,
                      const MapperConfig& config, const PinholeCamera& camera,
                      const std::function<void(std::size_t, std::size_t)>& progress = nullptr);

}  // namespace ovimap
