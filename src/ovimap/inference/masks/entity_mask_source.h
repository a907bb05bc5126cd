// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "ovimap/inference/masks/entity_config.h"
#include "ovimap/inference/masks/logit_grid.h"
#include "ovimap/inference/masks/mask_source.h"
#include "ovimap/inference/models/model_folder.h"
#include "ovimap/inference/models/onnx_session.h"

namespace ovimap {

/// Entities from a query-based network such as a Mask2Former or CropFormer export: one ONNX file
/// with the image in, and for each query class logits (the last class is "no object") and mask
/// logits out.
class EntityMaskSource : public MaskSource {
 public:
  /// Throws Error when the model is not of kind entity, a file's digest or a tensor's name or shape
  /// is not what model.yaml says.
  EntityMaskSource(const ModelFolder& model, const EntityConfig& config,
                   const RuntimeConfig& runtime);
  std::string kind() const override { return "entity"; }
  bool is_slow() const override { return true; }
  std::optional<Entities> entities(const Frame& frame,
                                   std::span<const MaskPrompt> prompts) override;

 private:
  ModelFolder model_;
  EntityConfig config_;
  OnnxSession session_;
};

/// What the queries mean in the image (the released CropFormer demo's rules): a query's class
/// probability is the largest of its softmax without "no object"; its score is that times the mean
/// mask probability inside its mask; lower scores are dropped; where masks overlap, the higher
/// score wins. `class_logits` is [1, Q, C + 1], `mask_logits` is [1, Q, grid.size, grid.size].
Entities entities_of_queries(const FloatTensor& class_logits, const FloatTensor& mask_logits,
                             const LogitGrid& grid, const EntityConfig& config);

}  // namespace ovimap
