// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "ovimap/inference/masks/mask_source.h"
#include "ovimap/inference/sam/entity_finder.h"
#include "ovimap/inference/sam/mask_pool.h"
#include "ovimap/inference/sam/sam_config.h"
#include "ovimap/inference/sam/sam_network.h"
#include "ovimap/inference/sam/thing_masks.h"

namespace ovimap {

/// Entities from a promptable network (method section 2), prompted adaptively: at geometric regions
/// first, then wherever no accepted mask covers the image yet; before both at the things that the
/// model's own finder sees, if it has one, and whose masks it is not sure enough of. Or on a dense
/// grid, which takes several times as long and is what the former is measured against.
class SamMaskSource : public MaskSource {
 public:
  SamMaskSource(const ModelFolder& model, const SamConfig& config, const RuntimeConfig& runtime);
  std::string kind() const override { return "sam"; }
  bool is_slow() const override { return true; }
  std::optional<Entities> entities(const Frame& frame,
                                   std::span<const MaskPrompt> prompts) override;

 private:
  void ask_where_expected(const ImageFeatures& features, const std::vector<Thing>& things,
                          const ThingMasks& masks, std::span<const MaskPrompt> prompts,
                          MaskPool& pool) const;
  void ask_where_unexplained(const ImageFeatures& features, std::span<const MaskPrompt> regions,
                             int prompts_allowed, MaskPool& pool) const;
  /// Offers the finder's own masks to the pool; the things of which it is not sure are returned.
  std::vector<MaskPrompt> things_to_ask(const std::vector<Thing>& things, const ThingMasks& masks,
                                        MaskPool& pool) const;
  void ask_on_grid(const ImageFeatures& features, MaskPool& pool) const;

  SamNetwork network_;
  std::optional<EntityFinder> finder_;  ///< where the model has one
  SamConfig config_;
};

}  // namespace ovimap
