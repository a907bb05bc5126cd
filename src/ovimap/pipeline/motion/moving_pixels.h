// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "ovimap/map/fusion/seen_free.h"
#include "ovimap/pipeline/motion/motion_config.h"

namespace ovimap {

/// A piece of surface that moves, as one frame shows it.
struct MovingPatch {
  int area_px = 0;
  int core_px = 0;          ///< of those, pixels that contradict space that was seen empty
  Eigen::AlignedBox3f box;  ///< world, metres
  Eigen::Vector3f centroid = Eigen::Vector3f::Zero();  ///< likewise
};

/// What moves in a frame.
struct MovingPixels {
  /// Id of pixels that a filter took out of the frame (Frame::taken_out), where they are of no
  /// patch.
  static constexpr std::uint16_t kTakenOut = 0xffff;

  IdImage
      ids;  ///< depth image size, patch of each pixel, [id - 1]; 0: it stands still; empty: all do
  std::vector<MovingPatch> patches;
  std::vector<BlockIndex> cells;  ///< of seen-empty space in which surface is seen, whatever it is
  bool refused = false;  ///< more would move than the map confirms: it is the frame that is wrong.
                         ///< Where nearly all of it would, as of a hand on the lens, it moves
};

/// Finds surface where frames had looked through, and what hangs together with it. `observation`
/// must have sigma_m and plane_slope; `map` is as it was before the frame. What lies within a voxel
/// or two of the map's surface stands still. Pure; the same bits for every number of threads.
MovingPixels find_moving(const VoxelMap& map, const SeenFree& space, const Observation& observation,
                         const MotionConfig& config);

}  // namespace ovimap
