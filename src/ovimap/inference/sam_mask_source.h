// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/inference/mask_source.h"
#include "ovimap/inference/sam_config.h"
#include "ovimap/inference/sam_network.h"

namespace ovimap {

/// Entities from a promptable network, prompted adaptively: at geometric regions first, then
/// wherever no accepted mask covers the image yet (method section 2).
class SamMaskSource : public MaskSource {
 public:
  SamMaskSource(const ModelFolder& model, const SamConfig& config, const RuntimeConfig& runtime);
  std::string kind() const override { return "sam"; }
  bool is_slow() const override { return true; }
  Entities entities(const Frame& frame, std::span<const MaskPrompt> prompts) override;

 private:
  SamNetwork network_;
  SamConfig config_;
};

}  // namespace ovimap
