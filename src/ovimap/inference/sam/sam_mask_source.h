// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "ovimap/inference/masks/mask_source.h"
#include "ovimap/inference/sam/entity_finder.h"
#include "ovimap/inference/sam/mask_pool.h"
#include "ovimap/inference/sam/sam_config.h"
#include "ovimap/inference/sam/sam_network.h"

namespace ovimap {

/// Entities from a promptable network (method section 2), prompted adaptively: at geometric regions
/// first, then wherever no accepted mask covers the image yet; before both at the things that the
/// model's own finder sees, if it has one. Or on a dense grid, which takes
/// several times as long and is what the former is measured against.
class SamMaskSource : public MaskSource {
 public:
  SamMaskSource(const ModelFolder& model, const SamConfig& config, const RuntimeConfig& runtime);
  std::string kind() const override { return "sam"; }
  bool is_slow() const override { return true; }
  std::optional<Entities> entities(const Frame& frame,
                                   std::span<const MaskPrompt> prompts) override;

 private:
  void ask_where_expected(const ImageFeatures& features, const std::optional<ThingCells>& cells,
                          std::span<const MaskPrompt> prompts, MaskPool& pool) const;
  void ask_where_unexplained(const ImageFeatures& features, std::span<const MaskPrompt> regions,
                             int prompts_allowed, MaskPool& pool) const;
  std::optional<ThingCells> thing_cells(const ImageFeatures& features,
                                        const RgbImage& image) const;
  void ask_on_grid(const ImageFeatures& features, MaskPool& pool) const;

  SamNetwork network_;
  std::optional<EntityFinder> finder_;  ///< where the model has one
  SamConfig config_;
};

}  // namespace ovimap
