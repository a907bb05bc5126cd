// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ovimap/inference/encoders/dual_encoder_spec.h"
#include "ovimap/inference/encoders/image_text_encoder.h"
#include "ovimap/inference/models/model_folder.h"
#include "ovimap/inference/models/onnx_session.h"
#include "ovimap/inference/text/tokenizer.h"

namespace ovimap {

/// An image network and a text network with one embedding space (CLIP, SigLIP), from a model folder
/// of kind dual_encoder.
class DualEncoder : public ImageTextEncoder {
 public:
  /// Opens what `use` needs; the rest when it is first asked for, which then throws likewise.
  /// Throws Error when the folder is of another kind, a file is missing or altered, or a network's
  /// tensors are not what model.yaml says.
  DualEncoder(const ModelFolder& model, const RuntimeConfig& runtime,
              EncoderUse use = EncoderUse::kBoth);

  const EncoderIdentity& identity() const override { return identity_; }
  std::optional<MatchCalibration> calibration() const override { return spec_.calibration; }
  std::string prompt_template() const override { return spec_.prompt_template; }
  Embeddings encode_images(std::span<const RgbImage> images) override;
  Embeddings encode_texts(std::span<const std::string> texts) override;

 private:
  /// A network, opened once.
  struct Network {
    std::once_flag opened;
    std::optional<OnnxSession> session;
    std::size_t at_once = 1;  ///< items in one run
  };
  Network& images();
  Network& texts();

  void run_images(std::span<const RgbImage> images, std::span<float> rows);
  void run_texts(std::span<const std::string> texts, std::span<float> rows);
  void run(const OnnxSession& session, const std::string& network,
           std::span<const TensorInput> inputs, std::span<float> rows) const;

  ModelFolder model_;
  DualEncoderSpec spec_;
  EncoderIdentity identity_;
  RuntimeConfig runtime_;
  std::unique_ptr<Tokenizer> tokenizer_;  // with the text network
  Network images_, texts_;
};

}  // namespace ovimap
