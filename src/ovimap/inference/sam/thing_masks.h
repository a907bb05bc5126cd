// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/inference/masks/logit_grid.h"
#include "ovimap/inference/sam/sam_network.h"
#include "ovimap/inference/sam/thing_cells.h"

namespace ovimap {

/// Masks of things without a prompt: sums of a few images over the whole view, weighed as the cell
/// says in which the thing's middle lies (YOLACT: Bolya et al., ICCV 2019), and terms of where a
/// pixel lies seen from that cell.
class ThingMasks {
 public:
  /// Of a finder that gives no masks, none. Throws Error where they are not on grids of
  /// `grid_size`.
  ThingMasks(FinderMaps maps, int grid_size);

  bool empty() const { return maps_.basis.empty(); }
  /// The mask of the thing in whose middle the cell lies, and how good the finder believes it to
  /// be.
  MaskProposals mask_at(const Eigen::Vector2i& cell, const LogitGrid& grid) const;

 private:
  float kernel(int term, const Eigen::Vector2i& cell) const;

  FinderMaps maps_;
};

}  // namespace ovimap
