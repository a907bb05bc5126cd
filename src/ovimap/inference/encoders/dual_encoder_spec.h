// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "ovimap/inference/encoders/image_text_encoder.h"
#include "ovimap/inference/models/model_folder.h"
#include "ovimap/inference/text/text_input.h"
#include "ovimap/inference/text/tokenizer.h"

namespace ovimap {

/// What model.yaml says about a model of kind dual_encoder beside its networks and input.
struct DualEncoderSpec {
  int dimension = 0;  ///< of an embedding
  TextSpec text;
  int items_at_once = 8;  ///< in one run; keeps a GPU busy, a CPU gains nothing from more
  std::optional<MatchCalibration> calibration;
  std::string prompt_template = "{}";
};

/// Throws Error naming the key that is missing or wrong, or a file without a digest.
DualEncoderSpec read_dual_encoder_spec(const ModelFolder& model);

/// The tokenizer that `spec` names, with its files. Throws Error when they do not load.
std::unique_ptr<Tokenizer> open_tokenizer(const ModelFolder& model, const TextSpec& spec);

}  // namespace ovimap
