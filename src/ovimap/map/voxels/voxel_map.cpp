// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/voxels/voxel_map.h"

#include <algorithm>
#include <utility>

#include <xxhash.h>

#include "ovimap/base/config.h"
#include "ovimap/base/memory/usable_memory.h"
#include "ovimap/base/parallel.h"
#include "ovimap/map/voxels/block_tiles.h"
#include "ovimap/map/voxels/label_slots.h"

namespace ovimap {

namespace {

/// Hash of what a block says, independent of how its palette happens to be numbered.
std::uint64_t block_hash(const VoxelBlock& block, const LabelForest& forest) {
  XXH64_hash_t hash = XXH64(block.index.data(), sizeof(int) * 3, 0);
  hash = XXH64(block.tsdf.data(), sizeof(block.tsdf), hash);
  hash = XXH64(block.weight.data(), sizeof(block.weight), hash);
  std::array<std::array<std::uint16_t, kBlockVoxels>, 3> colors;
  for (std::size_t v = 0; v < kBlockVoxels; ++v) {
    const FixedColor color = unpack_color(block.color[v]);
    for (std::size_t c = 0; c < colors.size(); ++c) colors[c][v] = color[c];
  }
  hash = XXH64(colors.data(), sizeof(colors), hash);
  std::vector<LabelSupport> labels;
  labels.reserve(kBlockVoxels * kLabelSlots);
  for (int v = 0; v < kBlockVoxels; ++v)
    for (const LabelSupport& held : voxel_labels(block, v, forest)) labels.push_back(held);
  hash = XXH64(labels.data(), labels.size() * sizeof(LabelSupport), hash);
  return block.doubted() ? XXH64(block.doubts.data(), block.doubts.size(), hash) : hash;
}

}  // namespace

void list_fields(VoxelMapConfig& config, ConfigFields& fields) {
  fields.add("voxel_size_m", config.voxel_size_m, 0.001f, 1.f, "edge of a voxel, metres");
  fields.add("truncation_voxels", config.truncation_voxels, 2, 20,
             "half width of the TSDF band, voxels");
  fields.add("max_weight", config.max_weight, 0.01f, 1e6f, "cap of a voxel's weight");
  fields.add("min_mesh_weight", config.min_mesh_weight, 0.f, 1e6f,
             "lighter voxels make no surface; 1: a standard error of one voxel, 0.125: of 2.8");
  fields.add("label_band_voxels", config.label_band_voxels, 0.5f, 20.f,
             "distance from the surface within which voxels take labels, voxels");
  fields.add("pixel_votes", config.pixel_votes,
             "whether a frame's vote for a label counts as the pixels along the voxel's side");
}

VoxelMap::VoxelMap(const VoxelMapConfig& config, std::size_t most_blocks)
    : config_(config),
      most_blocks_(std::min(most_blocks, VoxelRef::kMostBlocks)),
      room_bytes_(usable_memory() / 4 * 3),
      metres_per_unit_(config.truncation_m() / VoxelBlock::kTsdfScale) {}

const VoxelBlock* VoxelMap::find(const BlockIndex& index) const {
  const std::uint32_t slot = find_slot(index);
  return slot == kNoBlock ? nullptr : &block(slot);
}

std::uint32_t VoxelMap::find_slot(const BlockIndex& index) const {
  const BlockRegion* region = find_region(BlockRegion::index_of(index));
  return region ? region->slot(index) : kNoBlock;
}

const BlockRegion* VoxelMap::find_region(const BlockIndex& region) const {
  const auto found = region_positions_.find(pack_index(region));
  return found == region_positions_.end() ? nullptr : regions_[found->second].get();
}

BlockRegion& VoxelMap::find_or_create_region(const BlockIndex& region) {
  const auto [found, created] = region_positions_.try_emplace(
      pack_index(region), static_cast<std::uint32_t>(regions_.size()));
  if (created) regions_.push_back(std::make_unique<BlockRegion>(region));
  return *regions_[found->second];
}

std::uint32_t VoxelMap::add_slot(const BlockIndex& index, BlockPlace block) {
  if (blocks_.size() >= most_blocks_)
    throw Error(concat("a map has at most ", most_blocks_, " blocks of voxels of ",
                       config_.voxel_size_m,
                       " m, and this one needs more; take larger voxels (map.voxel_size_m), or map "
                       "the place in parts"));
  blocks_.push_back(std::move(block));
  indices_.push_back(index);
  return static_cast<std::uint32_t>(blocks_.size() - 1);
}

std::uint32_t VoxelMap::find_or_create(const BlockIndex& index) {
  BlockRegion& region = find_or_create_region(BlockRegion::index_of(index));
  if (region.slot(index) == kNoBlock) {
    auto block = spare_block(index);
    block->forest_epoch = labels_.epoch();
    region.put(index, add_slot(index, BlockPlace(std::move(block))));
    ++in_memory_;
  }
  return region.slot(index);
}

void VoxelMap::empty_blocks(const BlockChoice& chosen) {
  for_each_part(*this, [&](std::span<const Tile> tiles) {
    for (const Tile& tile : tiles) {
      std::vector<std::uint32_t> emptied;
      for (const std::uint32_t slot : tile.slots) {
        if (!chosen.contains(slot)) continue;
        VoxelBlock& block = writable_block(slot);
        block = VoxelBlock(indices_[slot]);
        block.forest_epoch = labels_.epoch();
        emptied.push_back(slot);
      }
      note_changes(emptied);
    }
  });
}

void VoxelMap::create_away(const BlockIndex& index) {
  BlockRegion& region = find_or_create_region(BlockRegion::index_of(index));
  OVIMAP_ASSERT(region.slot(index) == kNoBlock);
  region.put(index, add_slot(index, BlockPlace()));
}

VoxelBlock* VoxelMap::load(std::uint32_t slot) const {
  store_->load(*this, slot);
  return blocks_[slot].get();
}

void VoxelMap::evict(std::span<const std::uint32_t> slots) const {
  OVIMAP_ASSERT(frozen_.empty());
  for (const std::uint32_t slot : slots)
    if (auto block = blocks_[slot].put(nullptr)) {
      spares_.push_back(std::move(block));
      --in_memory_;
    }
}

std::unique_ptr<VoxelBlock> VoxelMap::spare_block(const BlockIndex& index) const {
  if (spares_.empty()) return std::make_unique<VoxelBlock>(index);
  std::unique_ptr<VoxelBlock> block = std::move(spares_.back());
  spares_.pop_back();
  *block = VoxelBlock(index);
  return block;
}

void VoxelMap::bring_back(std::uint32_t slot, std::unique_ptr<VoxelBlock> block) const {
  OVIMAP_ASSERT(!in_memory(slot));
  blocks_[slot].put(std::move(block));
  ++in_memory_;
}

std::vector<const VoxelBlock*> VoxelMap::freeze(std::span<const std::uint32_t> slots) {
  OVIMAP_ASSERT(frozen_.empty());
  frozen_.assign(blocks_.size(), 0);
  kept_.resize(blocks_.size());
  std::vector<const VoxelBlock*> blocks;
  blocks.reserve(slots.size());
  for (const std::uint32_t slot : slots) {
    frozen_[slot] = 1;
    blocks.push_back(&block(slot));
  }
  return blocks;
}

void VoxelMap::thaw() {
  frozen_.clear();
  kept_.clear();
  copies_ = 0;
}

void VoxelMap::replace_frozen(std::uint32_t slot) {
  frozen_[slot] = 0;
  kept_[slot] = blocks_[slot].put(std::make_unique<VoxelBlock>(block(slot)));
  std::atomic_ref(copies_).fetch_add(1, std::memory_order_relaxed);
}

std::vector<std::uint32_t> VoxelMap::ordered_slots() const {
  std::vector<std::uint32_t> slots(blocks_.size());
  for (std::uint32_t slot = 0; slot < slots.size(); ++slot) slots[slot] = slot;
  std::sort(slots.begin(), slots.end(), [this](std::uint32_t a, std::uint32_t b) {
    return pack_index(indices_[a]) < pack_index(indices_[b]);
  });
  return slots;
}

Label VoxelMap::label(VoxelRef ref) const {
  return ref ? voxel_label(block(ref.block()), ref.voxel(), labels_) : kNoLabel;
}

std::size_t VoxelMap::index_bytes() const {
  return blocks_.capacity() * sizeof(blocks_[0]) + indices_.capacity() * sizeof(indices_[0]) +
         regions_.size() * (sizeof(BlockRegion) + sizeof(regions_[0])) +
         region_positions_.bucket_count() * sizeof(std::pair<std::uint64_t, std::uint32_t>);
}

std::size_t VoxelMap::bytes() const {
  std::size_t bytes = index_bytes();
  for (const BlockPlace& place : blocks_)
    if (const VoxelBlock* block = place.get()) bytes += block->bytes();
  return bytes;
}

std::uint64_t VoxelMap::content_hash() const {
  const std::vector<std::uint32_t> slots = ordered_slots();
  std::vector<std::uint64_t> hash_of(slots.size());
  for_each_part(*this, [&](std::span<const Tile> tiles) {
    parallel_for(tiles.size(), 4, [&](std::size_t i) {
      for (const std::uint32_t slot : tiles[i].slots)
        hash_of[slot] = block_hash(block(slot), labels_);
    });
  });
  std::vector<std::uint64_t> hashes(slots.size());
  std::transform(slots.begin(), slots.end(), hashes.begin(),
                 [&](std::uint32_t slot) { return hash_of[slot]; });
  return XXH64(hashes.data(), hashes.size() * sizeof(std::uint64_t), 0);
}

}  // namespace ovimap
