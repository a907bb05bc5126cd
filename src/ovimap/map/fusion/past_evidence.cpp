// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/fusion/past_evidence.h"

#include <algorithm>
#include <span>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/map/voxels/block_tiles.h"

namespace ovimap {

namespace {

constexpr std::size_t kTilesPerTask = 2;

void discount(const PastEvidenceConfig& config, VoxelBlock& block) {
  const float most_weight = round_weight(config.most_weight);
  for (std::size_t v = 0; v < kBlockVoxels; ++v) {
    block.weight[v] = std::min(block.weight[v], most_weight);
    const int strongest = block.slots.empty() ? 0 : block.slots.front().support[v];
    if (strongest <= config.most_support) continue;
    for (LabelSlot& slot : block.slots)
      slot.support[v] =
          static_cast<std::uint16_t>(slot.support[v] * config.most_support / strongest);
  }
}

}  // namespace

void list_fields(PastEvidenceConfig& config, ConfigFields& fields) {
  fields.add("most_weight", config.most_weight, 0.001f, 1e6f,
             "of a voxel's distance, one over its squared standard error in voxels");
  fields.add("most_support", config.most_support, 1, 65535, "of a voxel's strongest label");
}

void discount_past(VoxelMap& map, const PastEvidenceConfig& config) {
  for_each_part(map, [&](std::span<const Tile> tiles) {
    parallel_for(tiles.size(), kTilesPerTask, [&](std::size_t i) {
      for (const std::uint32_t slot : tiles[i].slots) discount(config, map.writable_block(slot));
    });
    for (const Tile& tile : tiles) map.note_changes(tile.slots);
  });
}

}  // namespace ovimap
