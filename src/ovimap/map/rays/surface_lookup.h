// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/image/image.h"
#include "ovimap/map/voxels/label_slots.h"
#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

/// The map's surface voxel under each depth pixel: V(x) of the paper, with |tsdf| below one voxel.
///
/// A point that noise put off the surface is first moved along its ray by the distance its voxel
/// holds, once. None where depth is invalid or the map has no surface there.
Image<VoxelRef> surface_voxels(const VoxelMap& map, const DepthImage& depth,
                               const PinholeCamera& camera, const Pose& world_from_camera);

/// Looks voxels up, remembering the last block and region: neighbours mostly share them. One per
/// thread.
class VoxelFinder {
 public:
  explicit VoxelFinder(const VoxelMap& map)
      : map_(map), inverse_voxel_size_(1.f / map.config().voxel_size_m) {}

  /// Goes to the voxel at global voxel coordinates. False where the map has no block.
  bool seek(const Eigen::Vector3i& voxel) {
    const BlockIndex block(voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3);
    if (block != block_index_) seek_block(block);
    voxel_ = voxel_offset(voxel.x() & 7, voxel.y() & 7, voxel.z() & 7);
    return block_ != nullptr;
  }
  /// Goes to the voxel that holds the point.
  bool seek(const Eigen::Vector3f& point_in_world) {
    return seek(floor_to_int(point_in_world * inverse_voxel_size_));
  }

  // Where the last `seek` went, if it was true.
  const VoxelBlock& block() const { return *block_; }
  int voxel() const { return voxel_; }
  VoxelRef ref() const { return VoxelRef::of(slot_, voxel_); }
  /// Whether the voxel was ever observed.
  bool observed() const { return observed(static_cast<std::size_t>(voxel_)); }
  float distance_m() const { return map_.distance_m(*block_, voxel_); }
  /// Distance at the voxel that lies `offset` further in the same block; returns whether it was
  /// ever observed.
  bool read(int offset, float& distance_m) const {
    const auto v = static_cast<std::size_t>(voxel_ + offset);
    distance_m = map_.distance_m(*block_, voxel_ + offset);
    return observed(v);
  }

 private:
  bool observed(std::size_t voxel) const { return block_->tsdf[voxel] != 0; }

  void seek_block(const BlockIndex& block) {
    block_index_ = block;
    const BlockIndex region = BlockRegion::index_of(block);
    if (region != region_index_) {
      region_index_ = region;
      region_ = map_.find_region(region);
    }
    slot_ = region_ ? region_->slot(block) : kNoBlock;
    block_ = slot_ == kNoBlock ? nullptr : &map_.block(slot_);
  }

  const VoxelMap& map_;
  float inverse_voxel_size_;
  BlockIndex block_index_ = BlockIndex::Constant(1 << 24);  // outside every map, as the next
  BlockIndex region_index_ = BlockIndex::Constant(1 << 24);
  const BlockRegion* region_ = nullptr;
  const VoxelBlock* block_ = nullptr;
  std::uint32_t slot_ = kNoBlock;
  int voxel_ = 0;
};

/// Labels of surface voxels in the order of an image's pixels: neighbours are of the same block as
/// a rule, which is not sought again. (Remembering the voxel as well is slower: whether the next
/// pixel sees the same one cannot be predicted.)
class LabelReader {
 public:
  explicit LabelReader(const VoxelMap& map) : map_(map) {}

  /// As VoxelMap::label.
  Label at(VoxelRef ref) {
    if (!ref) return kNoLabel;
    if (ref.block() != slot_) seek(ref.block());
    return palette_ ? palette_[strongest_[ref.voxel()]]
                    : voxel_label(*block_, ref.voxel(), map_.labels());
  }

 private:
  void seek(std::uint32_t slot) {
    slot_ = slot;
    block_ = &map_.block(slot);
    const bool plain = !block_->slots.empty() && block_->forest_epoch == map_.labels().epoch();
    palette_ = plain ? block_->palette.data() : nullptr;
    strongest_ = plain ? block_->slots.front().label.data() : nullptr;
  }

  const VoxelMap& map_;
  std::uint32_t slot_ = kNoBlock;
  const VoxelBlock* block_ = nullptr;
  const Label* palette_ = nullptr;  ///< null where merges are still to be looked up
  const std::uint8_t* strongest_ = nullptr;
};

}  // namespace ovimap
