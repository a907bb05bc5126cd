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
  for (const LabelSlot& slot : block.slots)
    for (std::uint8_t position : slot.label) used[position] = true;
  std::array<std::uint8_t, kPaletteLimit> moved{};
  std::vector<Label> palette;
  for (std::size_t position = 0; position < block.palette.size(); ++position) {
    if (!used[position]) continue;
    moved[position] = static_cast<std::uint8_t>(palette.size());
    palette.push_back(block.palette[position]);
  }
  block.palette = std::move(palette);
  for (LabelSlot& slot : block.slots)
    for (std::uint8_t& position : slot.label) position = moved[position];
}

/// Moves a voxel's label forward past weaker ones.
void promote(VoxelBlock& block, std::size_t v, std::size_t slot) {
  for (; slot > 0; --slot) {
    LabelSlot &stronger = block.slots[slot - 1], &weaker = block.slots[slot];
    if (weaker.support[v] <= stronger.support[v]) return;
    std::swap(weaker.label[v], stronger.label[v]);
    std::swap(weaker.support[v], stronger.support[v]);
  }
}

/// Merged labels need fewer.
void drop_empty_slots(VoxelBlock& block) {
  const auto empty = [](const LabelSlot& slot) { return slot == LabelSlot(); };
  while (!block.slots.empty() && empty(block.slots.back())) block.slots.pop_back();
  block.slots.shrink_to_fit();
}

}  // namespace

VoxelLabels voxel_labels(const VoxelBlock& block, int voxel, const LabelForest& forest) {
  const auto v = static_cast<std::size_t>(voxel);
  VoxelLabels result{};
  std::size_t count = 0;
  for (const LabelSlot& slot : block.slots) {
    if (slot.label[v] == 0) continue;
    const Label label = forest.root(block.palette[slot.label[v]]);
    const auto same =
        std::find_if(result.begin(), result.begin() + static_cast<std::ptrdiff_t>(count),
                     [label](const LabelSupport& held) { return held.label == label; });
    if (same == result.begin() + static_cast<std::ptrdiff_t>(count)) result[count++].label = label;
    same->support += slot.support[v];
  }
  // Insertion sort: it is stable, and std::stable_sort would allocate for four items.
  for (std::size_t i = 1; i < count; ++i)
    for (std::size_t j = i; j > 0 && result[j].support > result[j - 1].support; --j)
      std::swap(result[j], result[j - 1]);
  return result;
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
      for (std::size_t s = 0; s < block.slots.size(); ++s) {
        const auto found =
            std::find(block.palette.begin(), block.palette.end(), labels[v][s].label);
        block.slots[s].label[v] = static_cast<std::uint8_t>(found - block.palette.begin());
        block.slots[s].support[v] = static_cast<std::uint16_t>(std::min<std::uint32_t>(
            labels[v][s].support, std::numeric_limits<std::uint16_t>::max()));
      }
    }
    drop_empty_slots(block);
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
  for (std::size_t s = 0; s < block.slots.size(); ++s) {
    LabelSlot& slot = block.slots[s];
    if (slot.label[v] != position) continue;
    slot.support[v] = static_cast<std::uint16_t>(
        std::min<int>(slot.support[v] + votes, std::numeric_limits<std::uint16_t>::max()));
    return promote(block, v, s);
  }
  const auto support = [&](std::size_t s) {
    return s < block.slots.size() ? block.slots[s].support[v] : std::uint16_t{0};
  };
  constexpr std::size_t kLast = kLabelSlots - 1;  // slots are ordered, so the last is the weakest
  const std::uint16_t lost = std::min(votes, support(kLast));
  for (LabelSlot& slot : block.slots)
    slot.support[v] = static_cast<std::uint16_t>(slot.support[v] - lost);
  if (votes == lost) return;
  std::size_t s = kLast;
  while (s > 0 && support(s - 1) == 0) --s;
  LabelSlot& slot = block.slot(s);
  slot.label[v] = position;
  slot.support[v] = static_cast<std::uint16_t>(votes - lost);
  promote(block, v, s);
}

}  // namespace ovimap
