// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/fusion/integrate.h"

#include "ovimap/base/parallel.h"
#include "ovimap/map/fusion/block_update.h"
#include "ovimap/map/voxels/label_slots.h"

namespace ovimap {

namespace {

constexpr std::size_t kUpdatedBlocksPerTask = 16;

template <class Update>
void update_blocks(VoxelMap& map, const Observation& observation,
                   std::span<const std::uint32_t> slots, const Update& update) {
  const FusionView view(map.config(), observation);
  parallel_for(slots.size(), kUpdatedBlocksPerTask, [&](std::size_t i) {
    VoxelBlock& block = map.writable_block(slots[i]);
    resolve_labels(block, map.labels());
    update(view, block);
  });
}

}  // namespace

std::vector<std::uint32_t> integrate(VoxelMap& map, const Observation& observation) {
  std::vector<std::uint32_t> slots = allocate_blocks(map, observation);
  integrate_in(map, observation, slots);
  return slots;
}

void integrate_in(VoxelMap& map, const Observation& observation,
                  std::span<const std::uint32_t> slots) {
  update_blocks(map, observation, slots, update_block);
}

std::vector<std::uint32_t> vote_labels(VoxelMap& map, const Observation& observation) {
  OVIMAP_ASSERT(observation.segment_ids != nullptr);
  std::vector<std::uint32_t> slots = allocate_blocks(map, observation);
  update_blocks(map, observation, slots, vote_in_block);
  return slots;
}

}  // namespace ovimap
