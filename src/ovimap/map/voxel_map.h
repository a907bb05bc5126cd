// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <tsl/robin_map.h>
#include <Eigen/Core>

#include "ovimap/map/label_forest.h"
#include "ovimap/map/voxel_block.h"

namespace ovimap {

class ConfigFields;

struct VoxelMapConfig {
  float voxel_size_m = 0.01f;
  int truncation_voxels = 5;      ///< the band around the surface is this wide to either side
  float max_weight = 1000.f;      ///< weights are capped here, so that the map follows change
  float min_mesh_weight = 1e-4f;  ///< lighter voxels make no surface
  float label_band_voxels =
      1.f;  ///< voxels this near to the observed surface take the segment's label

  float truncation_m() const { return voxel_size_m * static_cast<float>(truncation_voxels); }
  float block_size_m() const { return voxel_size_m * kBlockSide; }
};
void list_fields(VoxelMapConfig& config, ConfigFields& fields);

/// Position of a voxel in memory: slot of its block and offset in it. Valid as long as the map
/// lives.
struct VoxelRef {
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::uint32_t value = kNone;
  explicit operator bool() const { return value != kNone; }
  std::uint32_t block() const { return value / kBlockVoxels; }
  int voxel() const { return static_cast<int>(value % kBlockVoxels); }
  static VoxelRef of(std::uint32_t block, int voxel) {
    return {block * kBlockVoxels + static_cast<std::uint32_t>(voxel)};
  }
};

inline constexpr std::uint32_t kNoBlock = ~std::uint32_t{0};

/// A cube of 8 x 8 x 8 blocks and the slots of those that exist. Rays stay in one for long, and
/// leap over the space where there is none.
struct BlockRegion {
  explicit BlockRegion(const BlockIndex& region_index) : index(region_index) {
    slots.fill(kNoBlock);
  }
  static BlockIndex index_of(const BlockIndex& block) {
    return {block.x() >> 3, block.y() >> 3, block.z() >> 3};  // floor division for either sign
  }
  static std::size_t position(const BlockIndex& block) {
    return static_cast<std::size_t>((block.x() & 7) | (block.y() & 7) << 3 | (block.z() & 7) << 6);
  }
  std::uint32_t slot(const BlockIndex& block) const { return slots[position(block)]; }

  BlockIndex index;  ///< covers the blocks [index * 8, index * 8 + 8) along each axis
  std::array<std::uint32_t, kRegionBlocks * kRegionBlocks * kRegionBlocks> slots;
};

/// The sparse TSDF of the scene with per-voxel label support. World frame, metres. Blocks are
/// created by `integrate` and `vote_labels` alone and never move in memory.
class VoxelMap {
 public:
  explicit VoxelMap(const VoxelMapConfig& config = {});
  VoxelMap(VoxelMap&&) = default;
  VoxelMap& operator=(VoxelMap&&) = default;

  const VoxelMapConfig& config() const { return config_; }
  std::size_t block_count() const { return blocks_.size(); }
  std::size_t bytes() const;

  /// The block at `index`, or nullptr when that space was never near an observed surface.
  const VoxelBlock* find(const BlockIndex& index) const;
  /// kNoBlock where there is none.
  std::uint32_t find_slot(const BlockIndex& index) const;
  /// The region of the given index, nullptr when none of its blocks exists.
  const BlockRegion* find_region(const BlockIndex& region) const;

  /// Calls `visit(region)` for every region, in no particular order.
  template <class Visit>
  void for_each_region(Visit&& visit) const {
    for (const auto& region : regions_) visit(*region);
  }

  const VoxelBlock& block(std::uint32_t slot) const { return *blocks_[slot]; }
  /// To change it. Threads may ask for different slots at the same time.
  VoxelBlock& writable_block(std::uint32_t slot) {
    if (slot < frozen_.size() && frozen_[slot]) replace_frozen(slot);
    return *blocks_[slot];
  }

  /// Until `thaw`, these blocks stay as they are where the returned pointers lead: the map goes on
  /// with a copy of each block that it writes to. So they can be stored beside the mapping. Not
  /// while blocks are frozen already.
  std::vector<const VoxelBlock*> freeze(std::span<const std::uint32_t> slots);
  /// Frees what `freeze` kept.
  void thaw();

  /// Slot of the block at `index`, created when absent.
  std::uint32_t find_or_create(const BlockIndex& index);

  /// Slots in the order of their block indices (z, y, x): the same for every way the map was built.
  std::vector<std::uint32_t> ordered_slots() const;

  LabelForest& labels() { return labels_; }
  const LabelForest& labels() const { return labels_; }
  Label label(VoxelRef ref) const;

  /// Signed distance in metres, clamped to the truncation.
  float distance_m(const VoxelBlock& block, int voxel) const {
    return static_cast<float>(block.tsdf[static_cast<std::size_t>(voxel)]) * metres_per_unit_;
  }

  /// Hash of every block's content and label resolution; equal maps hash equal whatever the order
  /// in which blocks were created.
  std::uint64_t content_hash() const;

 private:
  struct KeyHash {  // robin_map takes the low bits, so the high ones are mixed in
    std::size_t operator()(std::uint64_t key) const;
  };
  using RegionPositions = tsl::robin_map<std::uint64_t, std::uint32_t, KeyHash>;
  BlockRegion& find_or_create_region(const BlockIndex& region);
  void replace_frozen(std::uint32_t slot);

  VoxelMapConfig config_;
  float metres_per_unit_;
  std::vector<std::unique_ptr<VoxelBlock>> blocks_;
  std::vector<std::unique_ptr<BlockRegion>> regions_;
  RegionPositions region_positions_;  ///< in regions_, by packed index
  LabelForest labels_;
  std::vector<std::uint8_t> frozen_;  ///< by slot; empty: none is
  /// By slot as well: frozen blocks that were written to since, as they were.
  std::vector<std::unique_ptr<VoxelBlock>> kept_;
};

/// Block that holds the point.
inline BlockIndex block_at(const Eigen::Vector3f& point_in_world, float inverse_block_size) {
  return floor_to_int(point_in_world * inverse_block_size);
}

}  // namespace ovimap
