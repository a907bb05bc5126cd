// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/surface/cell_rows.h"

#include <bit>
#include <cstring>

namespace ovimap {

namespace {

static_assert(std::endian::native == std::endian::little);

/// The signs of four 16-bit integers in a word, in the low bits.
unsigned four_signs(const VoxelBlock::Tsdf* values) {
  std::uint64_t word;
  std::memcpy(&word, values, sizeof(word));
  // The factor's powers move the sign of value i, at bit 16 i, to bit 48 + i.
  constexpr std::uint64_t kGather = 1ull << 48 | 1ull << 33 | 1ull << 18 | 1ull << 3;
  return static_cast<unsigned>((word >> 15 & 0x0001000100010001ull) * kGather >> 48 & 0xf);
}

unsigned inside_bits(const VoxelBlock::Tsdf* values) {
  return four_signs(values) | four_signs(values + 4) << 4;
}

unsigned observed_bits(const float* weights, float min_weight) {
  unsigned bits = 0;
  for (int i = 0; i < kBlockSide; ++i) bits |= static_cast<unsigned>(weights[i] > min_weight) << i;
  return bits;
}

}  // namespace

CellRows::CellRows(const VoxelMap& map, std::uint32_t slot)
    : min_weight_(map.config().min_mesh_weight) {
  const BlockIndex& index = map.block_index(slot);
  blocks_[0] = &map.block(slot);
  for (int i = 1; i < 8; ++i)
    blocks_[static_cast<std::size_t>(i)] =
        map.find(index + BlockIndex(i & 1, i >> 1 & 1, i >> 2 & 1));
  observed_.fill(kUnread);
  for (int z = 0; z < kSide; ++z)
    for (int y = 0; y < kSide; ++y) inside_[at(y, z)] = read_inside(y, z);
}

std::uint16_t CellRows::read_inside(int y, int z) const {
  const auto first = static_cast<std::size_t>(voxel_offset(0, y & 7, z & 7));
  const VoxelBlock *here = block(0, y, z), *next = block(kBlockSide, y, z);
  const unsigned own = here ? inside_bits(here->tsdf.data() + first) : 0u;
  return static_cast<std::uint16_t>(own | (next && next->tsdf[first] < 0 ? 1u << kBlockSide : 0u));
}

std::uint16_t CellRows::read_observed(int y, int z) const {
  const auto first = static_cast<std::size_t>(voxel_offset(0, y & 7, z & 7));
  const VoxelBlock *here = block(0, y, z), *next = block(kBlockSide, y, z);
  const unsigned own = here ? observed_bits(here->weight.data() + first, min_weight_) : 0u;
  return static_cast<std::uint16_t>(
      own | (next && next->weight[first] > min_weight_ ? 1u << kBlockSide : 0u));
}

unsigned CellRows::surface_cells(int y, int z) {
  const unsigned a = inside_[at(y, z)], b = inside_[at(y + 1, z)], c = inside_[at(y, z + 1)],
                 d = inside_[at(y + 1, z + 1)];
  const unsigned some = a | b | c | d, all = a & b & c & d;
  const unsigned crossed = (some | some >> 1) & ~(all & all >> 1) & 0xff;
  if (crossed == 0) return 0;
  const unsigned seen =
      observed(y, z) & observed(y + 1, z) & observed(y, z + 1) & observed(y + 1, z + 1);
  return crossed & seen & seen >> 1;
}

unsigned CellRows::inside_corners(int x, int y, int z) const {
  const auto pair = [&](int dy, int dz) -> unsigned {
    return inside_[at(y + dy, z + dz)] >> x & 3u;
  };
  return pair(0, 0) | pair(1, 0) << 2 | pair(0, 1) << 4 | pair(1, 1) << 6;
}

}  // namespace ovimap
