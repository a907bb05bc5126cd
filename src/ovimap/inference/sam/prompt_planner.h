// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "ovimap/inference/sam/mask_pool.h"

namespace ovimap {

/// A question to the network, and the geometric region it comes from (-1: from an uncovered place).
struct PlannedPrompt {
  PromptPoints points;
  int region = -1;
  bool boxed = false;
  int radius_grid_px = 0;  ///< of a disc as large as what it may explain
};

/// Points in the middle of side x side equal cells of the image, row by row.
std::vector<PromptPoints> grid_prompts(int width_px, int height_px, int side);

/// Chooses where to ask the network next, given the masks so far: objects that a map knows, by
/// their boxes; then the largest unexplained areas: geometric regions that no mask covers, by a
/// point inside; regions whose point did not explain them and small regions on much larger masks (a
/// mug on a table), by their box; uncovered discs, by their centre.
class PromptPlanner {
 public:
  PromptPlanner(const SamConfig& config, const LogitGrid& grid,
                std::span<const MaskPrompt> regions);

  /// Up to `count` prompts, all with the same number of points; none when nothing is left to ask.
  std::vector<PlannedPrompt> next(const MaskPool& pool, int count);
  /// Tells that the answer did not explain the prompt's region, or that no mask came of an
  /// uncovered place.
  void failed(const PlannedPrompt& prompt);

  /// The region that `prompt` comes from, nullptr for an uncovered place.
  const MaskPrompt* region_of(const PlannedPrompt& prompt) const;

 private:
  enum class RegionState { kOpen, kRetry, kDone };
  struct Candidate {
    PlannedPrompt prompt;
    float gain_px = 0;  ///< area it may explain, weighted
    Eigen::Vector2i centre_grid_px;
  };

  void append_known(std::vector<Candidate>& candidates) const;
  void append_regions(const MaskPool& pool, std::vector<Candidate>& candidates) const;
  void append_holes(const MaskPool& pool, int count, std::vector<Candidate>& candidates) const;
  float min_hole_radius_grid_px() const;
  void mark_asked(const Candidate& candidate);
  Eigen::Vector2i to_grid(Eigen::Vector2f in_image_px) const;
  float smallest_mask_at(const MaskPool& pool, Eigen::Vector2i grid_px) const;

  SamConfig config_;
  LogitGrid grid_;
  std::vector<MaskPrompt> regions_;  ///< largest first
  std::vector<RegionState> states_;
  BitMask tried_;  ///< around points that were asked
};

}  // namespace ovimap
