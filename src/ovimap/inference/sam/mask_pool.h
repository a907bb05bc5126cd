// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "ovimap/inference/masks/bit_mask.h"
#include "ovimap/inference/masks/logit_grid.h"
#include "ovimap/inference/masks/mask_source.h"
#include "ovimap/inference/sam/sam_config.h"
#include "ovimap/inference/sam/sam_network.h"
#include "ovimap/inference/sam/thing_cells.h"

namespace ovimap {

/// A mask that passed the quality tests.
struct AcceptedMask {
  BitMask mask;                   ///< on the logit grid
  int area = 0;                   ///< grid pixels
  float stability = 0;            ///< IoU between the masks at a raised and a lowered threshold
  float score = 0;                ///< predicted IoU, as far as it is believed, times stability
  bool own_region = false;        ///< fills the geometric region that prompted it
  std::vector<float> logits;      ///< size x size, for painting at full resolution
  Eigen::AlignedBox2f extent_px;  ///< in the colour image
  std::vector<Eigen::Vector2i> cells;  ///< of a finder: those whose middles it covers
};

/// Gathers the masks of one image and makes non-overlapping entities of them.
class MaskPool {
 public:
  /// Where a finder looked at the image, its `cells` tell parts from things.
  MaskPool(const SamConfig& config, const LogitGrid& grid,
           std::optional<ThingCells> cells = std::nullopt);

  /// Takes one of the proposals that pass the quality tests, unless it repeats a mask held already.
  /// With the geometric `region` that prompted, the best whose size is like the region's; without,
  /// the largest of those that score about as well as the best, because an entity is wanted rather
  /// than its part. After a box prompt (`boxed`) only masks that stay inside its box pass, and of
  /// what a finder saw (MaskPrompt::known) only one that is like it. Returns
  /// whether the answer explains the region, or, without one, whether any proposal passed.
  bool offer(const MaskProposals& proposals, const MaskPrompt* region = nullptr,
             bool boxed = false);

  /// Takes the one mask that a finder made of a `thing` by itself, if it is sure enough of it.
  /// Returns whether it is.
  bool offer_unasked(const MaskProposals& proposal, const MaskPrompt& thing);

  const std::vector<AcceptedMask>& masks() const { return masks_; }
  /// What the masks explain that entities would be made of now.
  BitMask covered() const;
  const LogitGrid& grid() const { return grid_; }

  /// Entities of the colour image: parts dropped, small masks painted over large ones. A mask most
  /// of which smaller ones hide is none: what is left of it shows through where those have their
  /// gaps (a mask of the whole scene between the things on a desk) and belongs together by no
  /// evidence.
  Entities entities() const;

 private:
  std::optional<AcceptedMask> test(const MaskProposals& proposals, int token,
                                   float min_predicted_iou) const;
  std::size_t largest_stable(const std::vector<AcceptedMask>& passed) const;
  std::size_t best_for_region(const std::vector<AcceptedMask>& passed,
                              const MaskPrompt& region) const;
  bool fills(const AcceptedMask& mask, const MaskPrompt& region) const;
  float share_inside(const AcceptedMask& mask, const MaskPrompt& region) const;
  void add(AcceptedMask mask);
  void locate(AcceptedMask& mask) const;
  bool is_part(const AcceptedMask& mask, const AcceptedMask& larger) const;
  std::vector<std::size_t> shown_masks() const;
  std::vector<std::size_t> whole_of(std::vector<std::size_t> largest_first) const;
  std::vector<std::size_t> hidden_of(const std::vector<std::size_t>& largest_first) const;

  SamConfig config_;
  LogitGrid grid_;
  std::optional<ThingCells> cells_;
  std::vector<AcceptedMask> masks_;
};

}  // namespace ovimap
