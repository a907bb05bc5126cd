// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/fusion/fade_votes.h"

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"
#include "ovimap/map/voxels/block_tiles.h"

namespace ovimap {

namespace {

void fade(VoxelBlock& block, int divisor) {
  for (auto& slot : block.support)
    for (std::uint16_t& votes : slot)
      votes = static_cast<std::uint16_t>((votes + divisor - 1) / divisor);
}

}  // namespace

void fade_votes(VoxelMap& map, int divisor) {
  OVIMAP_ASSERT(divisor >= 1);
  if (divisor == 1) return;
  for_each_part(map, [&](std::span<const Tile> tiles) {
    parallel_for(tiles.size(), 1, [&](std::size_t i) {
      for (const std::uint32_t slot : tiles[i].slots) fade(map.writable_block(slot), divisor);
    });
    for (const Tile& tile : tiles) map.note_changes(tile.slots);
  });
}

}  // namespace ovimap
