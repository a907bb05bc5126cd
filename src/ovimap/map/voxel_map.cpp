// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/voxel_map.h"

#include <algorithm>
#include <utility>

#include <xxhash.h>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/map/label_slots.h"

namespace ovimap {

namespace {

/// Hash of what a block says, independent of how its palette happens to be numbered.
std::uint64_t block_hash(const VoxelBlock& block, const LabelForest& forest) {
  XXH64_hash_t hash = XXH64(block.index.data(), sizeof(int) * 3, 0);
  hash = XXH64(block.tsdf.data(), sizeof(block.tsdf), hash);
  hash = XXH64(block.weight.data(), sizeof(block.weight), hash);
  hash = XXH64(block.color.data(), sizeof(block.color), hash);
  std::vector<LabelSupport> labels;
  labels.reserve(kBlockVoxels * kLabelSlots);
  for (int v = 0; v < kBlockVoxels; ++v)
    for (const LabelSupport& held : voxel_labels(block, v, forest)) labels.push_back(held);
  return XXH64(labels.data(), labels.size() * sizeof(LabelSupport), hash);
}

}  // namespace

void list_fields(VoxelMapConfig& config, ConfigFields& fields) {
  fields.add("voxel_size_m", config.voxel_size_m, 0.001f, 1.f, "edge of a voxel, metres");
  fields.add("truncation_voxels", config.truncation_voxels, 2, 20,
             "half width of the TSDF band, voxels");
  fields.add("max_weight", config.max_weight, 0.01f, 1e6f, "cap of a voxel's weight");
  fields.add("min_mesh_weight", config.min_mesh_weight, 0.f, 1e6f,
             "lighter voxels make no surface");
  fields.add("label_band_voxels", config.label_band_voxels, 0.5f, 20.f,
             "distance from the surface within which voxels take labels, voxels");
}

VoxelMap::VoxelMap(const VoxelMapConfig& config)
    : config_(config), metres_per_unit_(config.truncation_m() / VoxelBlock::kTsdfScale) {}

std::size_t VoxelMap::KeyHash::operator()(std::uint64_t key) const {
  key *= 0x9e3779b97f4a7c15ull;
  return static_cast<std::size_t>(key ^ key >> 32);
}

const VoxelBlock* VoxelMap::find(const BlockIndex& index) const {
  const std::uint32_t slot = find_slot(index);
  return slot == kNoBlock ? nullptr : blocks_[slot].get();
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

std::uint32_t VoxelMap::find_or_create(const BlockIndex& index) {
  BlockRegion& region = find_or_create_region(BlockRegion::index_of(index));
  std::uint32_t& slot = region.slots[BlockRegion::position(index)];
  if (slot == kNoBlock) {
    slot = static_cast<std::uint32_t>(blocks_.size());
    blocks_.push_back(std::make_unique<VoxelBlock>(index));
    blocks_.back()->forest_epoch = labels_.epoch();
  }
  return slot;
}

std::vector<const VoxelBlock*> VoxelMap::freeze(std::span<const std::uint32_t> slots) {
  OVIMAP_ASSERT(frozen_.empty());
  frozen_.assign(blocks_.size(), 0);
  kept_.resize(blocks_.size());
  std::vector<const VoxelBlock*> blocks;
  blocks.reserve(slots.size());
  for (const std::uint32_t slot : slots) {
    frozen_[slot] = 1;
    blocks.push_back(blocks_[slot].get());
  }
  return blocks;
}

void VoxelMap::thaw() {
  frozen_.clear();
  kept_.clear();
}

void VoxelMap::replace_frozen(std::uint32_t slot) {
  frozen_[slot] = 0;
  kept_[slot] = std::exchange(blocks_[slot], std::make_unique<VoxelBlock>(*blocks_[slot]));
}

std::vector<std::uint32_t> VoxelMap::ordered_slots() const {
  std::vector<std::uint32_t> slots(blocks_.size());
  for (std::uint32_t slot = 0; slot < slots.size(); ++slot) slots[slot] = slot;
  std::sort(slots.begin(), slots.end(), [this](std::uint32_t a, std::uint32_t b) {
    return pack_index(blocks_[a]->index) < pack_index(blocks_[b]->index);
  });
  return slots;
}

Label VoxelMap::label(VoxelRef ref) const {
  return ref ? voxel_label(*blocks_[ref.block()], ref.voxel(), labels_) : kNoLabel;
}

std::size_t VoxelMap::bytes() const {
  std::size_t palettes = 0;
  for (const auto& block : blocks_) palettes += block->palette.capacity() * sizeof(Label);
  return blocks_.size() * (sizeof(VoxelBlock) + sizeof(blocks_[0])) + palettes +
         regions_.size() * (sizeof(BlockRegion) + sizeof(regions_[0])) +
         region_positions_.bucket_count() * sizeof(std::pair<std::uint64_t, std::uint32_t>);
}

std::uint64_t VoxelMap::content_hash() const {
  const std::vector<std::uint32_t> slots = ordered_slots();
  std::vector<std::uint64_t> hashes(slots.size());
  parallel_for(slots.size(), 64,
               [&](std::size_t i) { hashes[i] = block_hash(*blocks_[slots[i]], labels_); });
  return XXH64(hashes.data(), hashes.size() * sizeof(std::uint64_t), 0);
}

}  // namespace ovimap
