// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/encoders/image_text_encoder.h"

#include "ovimap/inference/encoders/dual_encoder.h"
#include "ovimap/inference/models/model_folder.h"

namespace ovimap {

std::string preferred_encoder(const std::vector<std::filesystem::path>& model_dirs) {
  std::string name = kDefaultEncoder;
  int greatest = 0;
  for (const ModelListing& model : list_models(model_search_path(model_dirs))) {
    if (model.kind != "dual_encoder" || model.doubtful || model.preference <= greatest) continue;
    greatest = model.preference;
    name = model.name;
  }
  return name;
}

std::unique_ptr<ImageTextEncoder> make_image_text_encoder(
    const std::string& spec, const RuntimeConfig& runtime,
    const std::vector<std::filesystem::path>& model_dirs, EncoderUse use) {
  if (spec.empty() || spec == "none") return nullptr;
  const std::string name = spec == "default" ? kDefaultEncoder : spec;
  return std::make_unique<DualEncoder>(
      read_model_folder(named_model(name, model_search_path(model_dirs))), runtime, use);
}

}  // namespace ovimap
