// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "ovimap/map/voxels/label_forest.h"
#include "ovimap/map/voxels/voxel_block.h"

namespace ovimap {

struct LabelSupport {
  Label label = kNoLabel;
  std::uint32_t support = 0;
};

/// The labels of a voxel, merged ones resolved and summed, strongest first; ties keep slot order.
/// Unused places have label 0.
using VoxelLabels = std::array<LabelSupport, kLabelSlots>;
VoxelLabels voxel_labels(const VoxelBlock& block, int voxel, const LabelForest& forest);

/// argmax of the supports: the label of the voxel (paper section 3.1), 0 when it has none.
inline Label voxel_label(const VoxelBlock& block, int voxel, const LabelForest& forest) {
  if (block.forest_epoch == forest.epoch())
    return block.palette[block.strongest(static_cast<std::size_t>(voxel))];
  return voxel_labels(block, voxel, forest)[0].label;
}

/// Writes merges into the block's palette and slots. Needed before add_support.
void resolve_labels(VoxelBlock& block, const LabelForest& forest);

/// Position of `label` (a root) in the block's palette, added when absent; 0 when the palette is
/// full of labels that are in use (255 in one block), in which case the vote is lost.
std::uint8_t palette_position(VoxelBlock& block, Label label);

/// One frame's `votes` (at least one) of a voxel for a palette position: O_v(k) += votes.
///
/// When all slots are taken by others every support drops, by the votes or by what the weakest has
/// (Misra and Gries 1982, with weights): a label with more than 1/(slots+1) of all votes always
/// keeps a slot. Slots stay ordered by support; a
/// newcomer overtakes only with strictly more support, so ties go to the label already held.
void add_support(VoxelBlock& block, int voxel, std::uint8_t position, std::uint16_t votes);

}  // namespace ovimap
