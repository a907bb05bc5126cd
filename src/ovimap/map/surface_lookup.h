// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/image/image.h"
#include "ovimap/map/voxel_map.h"

namespace ovimap {

/// The map's surface voxel under each depth pixel: V(x) of the paper, with |tsdf| below one voxel.
///
/// A point that noise put off the surface is first moved along its ray by the distance its voxel
/// holds, once. None where depth is invalid or the map has no surface there.
Image<VoxelRef> surface_voxels(const VoxelMap& map, const DepthImage& depth,
                               const PinholeCamera& camera, const Pose& world_from_camera);

/// Looks voxels up by world position, remembering the last block: neighbours mostly share it. One
/// per thread.
class VoxelFinder {
 public:
  explicit VoxelFinder(const VoxelMap& map)
      : map_(map), inverse_voxel_size_(1.f / map.config().voxel_size_m) {}

  /// The voxel that holds the point, none where the map has no block.
  VoxelRef find(const Eigen::Vector3f& point_in_world) {
    return find_voxel(floor_to_int(point_in_world * inverse_voxel_size_));
  }

  /// The voxel at global voxel coordinates.
  VoxelRef find_voxel(const Eigen::Vector3i& voxel) {
    const BlockIndex block(voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3);
    if (block != last_index_) {
      last_index_ = block;
      last_slot_ = map_.find_slot(block);
    }
    if (last_slot_ == VoxelMap::kNoBlock) return {};
    return VoxelRef::of(last_slot_, voxel_offset(voxel.x() & 7, voxel.y() & 7, voxel.z() & 7));
  }

 private:
  const VoxelMap& map_;
  float inverse_voxel_size_;
  BlockIndex last_index_ = BlockIndex::Constant(1 << 20);  // outside every map
  std::uint32_t last_slot_ = VoxelMap::kNoBlock;
};

}  // namespace ovimap
