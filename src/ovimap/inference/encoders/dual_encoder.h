// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>

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
  /// The first few texts are encoded by the text network as its file has it, which opens faster.
  /// The other form opens when more are asked for; their embeddings differ by rounding alone.
  ///
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
  Network& texts(SessionUse use);
  /// Which of the text networks shall encode the next `count` texts.
  SessionUse use_of(std::size_t count);

  void run_images(std::span<const RgbImage> images, std::span<float> rows);
  void run_texts(const OnnxSession& session, std::span<const std::string> texts,
                 std::span<float> rows) const;
  void run(const OnnxSession& session, const std::string& network,
           std::span<const TensorInput> inputs, std::span<float> rows) const;

  ModelFolder model_;
  DualEncoderSpec spec_;
  EncoderIdentity identity_;
  RuntimeConfig runtime_;
  std::once_flag text_files_;             // are opened
  std::unique_ptr<Tokenizer> tokenizer_;  // one of them
  Network images_, texts_, few_texts_;
  std::atomic<std::size_t> texts_asked_ = 0;
};

}  // namespace ovimap
