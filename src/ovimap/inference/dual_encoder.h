// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ovimap/inference/dual_encoder_spec.h"
#include "ovimap/inference/image_text_encoder.h"
#include "ovimap/inference/model_folder.h"
#include "ovimap/inference/onnx_session.h"
#include "ovimap/inference/tokenizer.h"

namespace ovimap {

/// An image network and a text network with one embedding space (CLIP, SigLIP), from a model folder
/// of kind dual_encoder.
class DualEncoder : public ImageTextEncoder {
 public:
  /// Throws Error when the folder is of another kind, a file is missing or altered, or a network's
  /// tensors are not what model.yaml says.
  DualEncoder(const ModelFolder& model, const RuntimeConfig& runtime);

  const EncoderIdentity& identity() const override { return identity_; }
  std::optional<MatchCalibration> calibration() const override { return spec_.calibration; }
  std::string prompt_template() const override { return spec_.prompt_template; }
  Embeddings encode_images(std::span<const RgbImage> images) override;
  Embeddings encode_texts(std::span<const std::string> texts) override;

 private:
  void run_images(std::span<const RgbImage> images, std::span<float> rows) const;
  void run_texts(std::span<const std::string> texts, std::span<float> rows) const;
  void run(const OnnxSession& session, const std::string& network,
           std::span<const TensorInput> inputs, std::span<float> rows) const;

  ModelFolder model_;
  DualEncoderSpec spec_;
  EncoderIdentity identity_;
  std::unique_ptr<Tokenizer> tokenizer_;
  OnnxSession image_session_, text_session_;
  std::size_t images_at_once_ = 1, texts_at_once_ = 1;
};

}  // namespace ovimap
