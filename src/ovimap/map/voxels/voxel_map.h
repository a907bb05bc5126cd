// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <tsl/robin_map.h>
#include <Eigen/Core>

#include "ovimap/map/voxels/block_choice.h"
#include "ovimap/map/voxels/label_forest.h"
#include "ovimap/map/voxels/voxel_block.h"

namespace ovimap {

class ConfigFields;

struct VoxelMapConfig {
  float voxel_size_m = 0.01f;
  int truncation_voxels = 5;       ///< the band around the surface is this wide to either side
  float max_weight = 1000.f;       ///< weights are capped here, so that the map follows change
  float min_mesh_weight = 0.125f;  ///< lighter voxels make no surface: their standard error is over
                                   ///< 2.8 voxels (see integrate)
  float label_band_voxels =
      1.f;                  ///< voxels this near to the observed surface take the segment's label
  bool pixel_votes = true;  ///< a frame's vote counts as the pixels along a voxel's side, so that
                            ///< who sees it from near tells more than who sees it from afar; false:
                            ///< as one (the paper)

  float truncation_m() const { return voxel_size_m * static_cast<float>(truncation_voxels); }
  float block_size_m() const { return voxel_size_m * kBlockSide; }
};
void list_fields(VoxelMapConfig& config, ConfigFields& fields);

/// Position of a voxel in memory: slot of its block and offset in it. Valid as long as the map
/// lives.
struct VoxelRef {
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  /// Of a map: a voxel of one more would have the number of another, or be none.
  static constexpr std::size_t kMostBlocks = kNone / kBlockVoxels;
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
  /// The inverse of both.
  static BlockIndex block_at(const BlockIndex& region, std::size_t position) {
    const auto p = static_cast<int>(position);
    return region * kRegionBlocks + BlockIndex(p & 7, p >> 3 & 7, p >> 6);
  }
  std::uint32_t slot(const BlockIndex& block) const { return slots[position(block)]; }
  void put(const BlockIndex& block, std::uint32_t slot) {
    slots[position(block)] = slot;
    groups |= std::uint64_t{1} << group(static_cast<int>(position(block)));
  }
  /// Of 2 x 2 x 2 blocks, the one that the position is in: a bit of `groups`.
  static int group(int position) {
    return (position >> 1 & 3) | (position >> 4 & 3) << 2 | (position >> 7 & 3) << 4;
  }

  BlockIndex index;          ///< covers the blocks [index * 8, index * 8 + 8) along each axis
  std::uint64_t groups = 0;  ///< in which there is a block
  std::array<std::uint32_t, kRegionBlocks * kRegionBlocks * kRegionBlocks> slots;
};

class VoxelMap;

/// Where blocks are that are not in memory (VoxelMap::keep_in).
class BlockStore {
 public:
  virtual ~BlockStore() = default;
  /// Brings a block of the map back, with VoxelMap::bring_back. Several threads may ask at the same
  /// time. Throws Error when it cannot be read.
  virtual void load(const VoxelMap& map, std::uint32_t slot) = 0;
  /// These blocks are not any more as they were stored.
  virtual void note_changes(const VoxelMap& map, std::span<const std::uint32_t> slots) = 0;
  /// Evicts what memory cannot hold, at a moment at which nobody refers to a block.
  virtual void trim(const VoxelMap& map) = 0;
};

/// Owns a block, or none. Threads may look while another puts one there.
class BlockPlace {
 public:
  BlockPlace() = default;
  explicit BlockPlace(std::unique_ptr<VoxelBlock> block) : block_(block.release()) {}
  BlockPlace(BlockPlace&& other) noexcept : block_(other.put(nullptr).release()) {}
  BlockPlace& operator=(BlockPlace&&) = delete;
  ~BlockPlace() { delete get(); }

  VoxelBlock* get() const { return block_.load(std::memory_order_acquire); }
  /// Returns what was there. Not at the same time as another `put`.
  std::unique_ptr<VoxelBlock> put(std::unique_ptr<VoxelBlock> block) {
    std::unique_ptr<VoxelBlock> before(get());
    block_.store(block.release(), std::memory_order_release);
    return before;
  }

 private:
  std::atomic<VoxelBlock*> block_ = nullptr;
};

/// The sparse TSDF of the scene with per-voxel label support. World frame, metres. Blocks are
/// created by `integrate` and `vote_labels` alone and never move in memory. With a store
/// (`keep_in`), blocks may be there instead of in memory; whoever asks for one gets it all the
/// same, so that what is in memory is no part of what the map says, and const allows it to change.
class VoxelMap {
 public:
  /// `most_blocks`: one more is refused (add_slot); at most VoxelRef::kMostBlocks.
  explicit VoxelMap(const VoxelMapConfig& config = {},
                    std::size_t most_blocks = VoxelRef::kMostBlocks);
  VoxelMap(VoxelMap&&) = default;
  VoxelMap& operator=(VoxelMap&&) = default;

  const VoxelMapConfig& config() const { return config_; }
  std::size_t block_count() const { return blocks_.size(); }
  /// Of memory, the blocks that are in it and what leads to them.
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

  const BlockIndex& block_index(std::uint32_t slot) const { return indices_[slot]; }
  /// Valid until `trim`.
  const VoxelBlock& block(std::uint32_t slot) const {
    const VoxelBlock* block = blocks_[slot].get();
    if (block == nullptr) [[unlikely]]
      block = load(slot);
    return *block;
  }
  /// To change it. Threads may ask for different slots at the same time.
  VoxelBlock& writable_block(std::uint32_t slot) {
    if (slot < frozen_.size() && frozen_[slot]) replace_frozen(slot);
    VoxelBlock* block = blocks_[slot].get();
    if (block == nullptr) [[unlikely]]
      block = load(slot);
    return *block;
  }

  /// From now on blocks may be in the store instead of in memory.
  void keep_in(std::shared_ptr<BlockStore> store) { store_ = std::move(store); }
  bool has_store() const { return store_ != nullptr; }
  /// Lets the store make room; references to blocks end here. Call between the parts of anything
  /// that walks over a whole map.
  void trim() const {
    if (store_) store_->trim(*this);
  }

  /// Tells the store, if there is one, of blocks that were written to since it was told last;
  /// before the next `trim`.
  void note_changes(std::span<const std::uint32_t> slots) const {
    if (store_) store_->note_changes(*this, slots);
  }

  // For the store.
  bool in_memory(std::uint32_t slot) const { return blocks_[slot].get() != nullptr; }
  /// Takes blocks out of memory that the store has as they are. Not while blocks are frozen.
  void evict(std::span<const std::uint32_t> slots) const;
  /// An empty block to be filled for `bring_back`.
  std::unique_ptr<VoxelBlock> spare_block(const BlockIndex& index) const;
  void bring_back(std::uint32_t slot, std::unique_ptr<VoxelBlock> block) const;
  /// Frees evicted blocks that wait to be used again, all but so many; returns how many wait.
  std::size_t keep_spares(std::size_t most) const {
    if (spares_.size() > most) spares_.resize(most);
    return spares_.size();
  }
  /// Creates a block that is in the store alone. There must be none at `index`.
  void create_away(const BlockIndex& index);
  /// The part of `bytes` that only grows: what leads to blocks, not blocks.
  std::size_t index_bytes() const;
  /// Blocks in memory, copies that `freeze` made included.
  std::size_t blocks_in_memory() const { return in_memory_ + copies_; }

  /// Bytes that blocks may take in memory: a frame that needs more is refused (allocate_blocks).
  /// Three quarters of what the process may use, unless it is told.
  std::size_t room_bytes() const { return room_bytes_; }
  void set_room(std::size_t bytes) { room_bytes_ = bytes; }

  /// Until `thaw`, these blocks stay as they are where the returned pointers lead: the map goes on
  /// with a copy of each block that it writes to. So they can be stored beside the mapping. Not
  /// while blocks are frozen already.
  std::vector<const VoxelBlock*> freeze(std::span<const std::uint32_t> slots);
  /// Frees what `freeze` kept.
  void thaw();

  /// Slot of the block at `index`, created when absent. Throws Error when the map has as many as
  /// can be referred to.
  std::uint32_t find_or_create(const BlockIndex& index);

  /// Makes these blocks ones that were never observed. Blocks stay, and so do labels. Tells the
  /// store and lets it make room on the way.
  void empty_blocks(const BlockChoice& chosen);

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
  using RegionPositions = tsl::robin_map<std::uint64_t, std::uint32_t, PackedIndexHash>;
  BlockRegion& find_or_create_region(const BlockIndex& region);
  void replace_frozen(std::uint32_t slot);

  std::uint32_t add_slot(const BlockIndex& index, BlockPlace block);
  [[gnu::noinline]] VoxelBlock* load(std::uint32_t slot) const;

  VoxelMapConfig config_;
  std::size_t most_blocks_;
  std::size_t room_bytes_;
  float metres_per_unit_;
  mutable std::vector<BlockPlace> blocks_;
  std::vector<BlockIndex> indices_;  ///< of the blocks, by slot
  mutable std::size_t in_memory_ = 0;
  /// Evicted blocks, to be used again: allocators give little memory back.
  mutable std::vector<std::unique_ptr<VoxelBlock>> spares_;
  std::shared_ptr<BlockStore> store_;
  std::vector<std::unique_ptr<BlockRegion>> regions_;
  RegionPositions region_positions_;  ///< in regions_, by packed index
  LabelForest labels_;
  std::vector<std::uint8_t> frozen_;  ///< by slot; empty: none is
  /// By slot as well: frozen blocks that were written to since, as they were.
  std::vector<std::unique_ptr<VoxelBlock>> kept_;
  std::size_t copies_ = 0;  ///< how many
};

/// Block that holds the point.
inline BlockIndex block_at(const Eigen::Vector3f& point_in_world, float inverse_block_size) {
  return floor_to_int(point_in_world * inverse_block_size);
}

}  // namespace ovimap
