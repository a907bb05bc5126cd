// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/voxels/label_slots.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

constexpr std::size_t kPaletteLimit = 256;

/// Forgets palette entries that no slot holds any more.
void compact_palette(VoxelBlock& block) {
  std::array<bool, kPaletteLimit> used{};
  used[0] = true;
  for (const auto& slot : block.label)
    for (std::uint8_t position : slot) used[position] = true;
  std::array<std::uint8_t, kPaletteLimit> moved{};
  std::vector<Label> palette;
  for (std::size_t position = 0; position < block.palette.size(); ++position) {
    if (!used[position]) continue;
    moved[position] = static_cast<std::uint8_t>(palette.size());
    palette.push_back(block.palette[position]);
  }
  block.palette = std::move(palette);
  for (auto& slot : block.label)
    for (std::uint8_t& position : slot) position = moved[position];
}

void swap_slots(VoxelBlock& block, int voxel, int a, int b) {
  const auto v = static_cast<std::size_t>(voxel), i = static_cast<std::size_t>(a),
             j = static_cast<std::size_t>(b);
  std::swap(block.label[i][v], block.label[j][v]);
  std::swap(block.support[i][v], block.support[j][v]);
}

/// Moves a slot forward past weaker ones.
void promote(VoxelBlock& block, int voxel, int slot) {
  const auto v = static_cast<std::size_t>(voxel);
  for (; slot > 0; --slot) {
    const auto s = static_cast<std::size_t>(slot);
    if (block.support[s][v] <= block.support[s - 1][v]) return;
    swap_slots(block, voxel, slot, slot - 1);
  }
}

}  // namespace

VoxelLabels voxel_labels(const VoxelBlock& block, int voxel, const LabelForest& forest) {
  const auto v = static_cast<std::size_t>(voxel);
  VoxelLabels result{};
  std::size_t count = 0;
  for (std::size_t s = 0; s < kLabelSlots; ++s) {
    if (block.label[s][v] == 0) continue;
    const Label label = forest.root(block.palette[block.label[s][v]]);
    const auto same =
        std::find_if(result.begin(), result.begin() + static_cast<std::ptrdiff_t>(count),
                     [label](const LabelSupport& held) { return held.label == label; });
    if (same == result.begin() + static_cast<std::ptrdiff_t>(count)) result[count++].label = label;
    same->support += block.support[s][v];
  }
  // Insertion sort: it is stable, and std::stable_sort would allocate for four items.
  for (std::size_t i = 1; i < count; ++i)
    for (std::size_t j = i; j > 0 && result[j].support > result[j - 1].support; --j)
      std::swap(result[j], result[j - 1]);
  return result;
}

Label voxel_label(const VoxelBlock& block, int voxel, const LabelForest& forest) {
  if (block.forest_epoch == forest.epoch())
    return block.palette[block.label[0][static_cast<std::size_t>(voxel)]];
  return voxel_labels(block, voxel, forest)[0].label;
}

void resolve_labels(VoxelBlock& block, const LabelForest& forest) {
  if (block.forest_epoch == forest.epoch()) return;
  const bool merged = std::any_of(block.palette.begin(), block.palette.end(),
                                  [&](Label label) { return forest.root(label) != label; });
  if (merged) {
    std::vector<VoxelLabels> labels(kBlockVoxels);
    for (int v = 0; v < kBlockVoxels; ++v)
      labels[static_cast<std::size_t>(v)] = voxel_labels(block, v, forest);
    for (Label& label : block.palette) label = forest.root(label);
    for (std::size_t v = 0; v < kBlockVoxels; ++v) {
      for (std::size_t s = 0; s < kLabelSlots; ++s) {
        const auto found =
            std::find(block.palette.begin(), block.palette.end(), labels[v][s].label);
        block.label[s][v] = static_cast<std::uint8_t>(found - block.palette.begin());
        block.support[s][v] = static_cast<std::uint16_t>(std::min<std::uint32_t>(
            labels[v][s].support, std::numeric_limits<std::uint16_t>::max()));
      }
    }
    compact_palette(block);
  }
  block.forest_epoch = forest.epoch();
}

std::uint8_t palette_position(VoxelBlock& block, Label label) {
  const auto found = std::find(block.palette.begin(), block.palette.end(), label);
  if (found != block.palette.end()) return static_cast<std::uint8_t>(found - block.palette.begin());
  if (block.palette.size() == kPaletteLimit) compact_palette(block);
  if (block.palette.size() == kPaletteLimit) return 0;
  block.palette.push_back(label);
  return static_cast<std::uint8_t>(block.palette.size() - 1);
}

void add_support(VoxelBlock& block, int voxel, std::uint8_t position, std::uint16_t votes) {
  OVIMAP_ASSERT(position != 0 && votes > 0);
  const auto v = static_cast<std::size_t>(voxel);
  for (std::size_t s = 0; s < kLabelSlots; ++s) {
    if (block.label[s][v] != position) continue;
    block.support[s][v] = static_cast<std::uint16_t>(
        std::min<int>(block.support[s][v] + votes, std::numeric_limits<std::uint16_t>::max()));
    return promote(block, voxel, static_cast<int>(s));
  }
  constexpr std::size_t kLast = kLabelSlots - 1;  // slots are ordered, so the last is the weakest
  const std::uint16_t lost = std::min(votes, block.support[kLast][v]);
  for (auto& slot : block.support) slot[v] = static_cast<std::uint16_t>(slot[v] - lost);
  if (votes == lost) return;
  std::size_t slot = kLast;
  while (slot > 0 && block.support[slot - 1][v] == 0) --slot;
  block.label[slot][v] = position;
  block.support[slot][v] = static_cast<std::uint16_t>(votes - lost);
  promote(block, voxel, static_cast<int>(slot));
}

}  // namespace ovimap
