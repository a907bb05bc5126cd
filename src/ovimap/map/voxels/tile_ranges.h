// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/image/image.h"
#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

/// Between which depths the blocks of the map lie, for every tile of 8 x 8 pixels: rays need be
/// marched only there. Costs one projection per block in view, not per ray.
class TileRanges {
 public:
  static constexpr int kTile_px = 8;
  struct Range {
    float near_m, far_m;  ///< along the optical axis; near > far: no block in this tile
  };

  TileRanges(const VoxelMap& map, const PinholeCamera& camera, const Pose& world_from_camera,
             float max_depth_m);

  const Range& at_pixel(int x, int y) const { return ranges_.at(x / kTile_px, y / kTile_px); }

 private:
  void add_block(const Eigen::Vector3f& center_in_camera, float half_side);
  void widen(float u_min, float v_min, float u_max, float v_max, float near_m, float far_m);

  PinholeCamera camera_;
  Eigen::Matrix3f camera_from_world_;
  Image<Range> ranges_;
};

}  // namespace ovimap
