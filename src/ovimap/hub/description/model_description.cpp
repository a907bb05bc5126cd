// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/description/model_description.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "ovimap/base/bounded_json.h"
#include "ovimap/base/error.h"
#include "ovimap/base/listed.h"
#include "ovimap/hub/description/image_processor.h"
#include "ovimap/hub/description/tokenizer_files.h"
#include "ovimap/inference/models/onnx_session.h"

namespace ovimap {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::json;
using Roles = std::vector<std::pair<std::string, std::string>>;  // tensor: role

bool has(const std::vector<TensorInfo>& tensors, const std::string& name) {
  return std::any_of(tensors.begin(), tensors.end(),
                     [&name](const TensorInfo& tensor) { return tensor.name == name; });
}

std::string names_of(const std::vector<TensorInfo>& tensors) {
  return listed(tensors, &TensorInfo::name);
}

/// Those of `roles` that the network has.
std::map<std::string, std::string> present(const std::vector<TensorInfo>& tensors,
                                           const Roles& roles) {
  std::map<std::string, std::string> found;
  for (const auto& [tensor, role] : roles)
    if (has(tensors, tensor)) found.emplace(role, tensor);  // the first of a role
  return found;
}

void require(const fs::path& file, const std::map<std::string, std::string>& found,
             const std::vector<TensorInfo>& tensors, const Roles& roles) {
  for (const auto& [tensor, role] : roles)
    if (!found.contains(role))
      throw Error(concat("network ", file.string(), " has no tensor for ", role, "; it has ",
                         names_of(tensors), ", ovimap looks for ", tensor));
}

void refuse_half(const fs::path& file, const std::vector<TensorInfo>& tensors) {
  for (const TensorInfo& tensor : tensors)
    if (tensor.type == TensorType::kOther)
      throw Error(concat("network ", file.string(), " takes or gives '", tensor.name,
                         "' as another type than float32 or integers; take --variant full"));
}

NetworkSpec network_spec(const fs::path& folder, const std::string& file,
                         const OnnxSession& session, const Roles& inputs, const Roles& outputs) {
  refuse_half(folder / file, session.inputs());
  const NetworkSpec spec{file, present(session.inputs(), inputs),
                         present(session.outputs(), outputs)};
  require(folder / file, spec.inputs, session.inputs(), {inputs.front()});
  require(folder / file, spec.outputs, session.outputs(), {outputs.front()});
  return spec;
}

void check_side(const fs::path& file, const TensorInfo& image, int side) {
  for (const std::size_t axis : {2u, 3u})
    if (image.shape.size() == 4 && image.shape[axis] > 0 && image.shape[axis] != side)
      throw Error(concat("network ", file.string(), " takes images of ", to_text(image.shape),
                         ", but preprocessor_config.json makes ", side, " pixels"));
}

std::int64_t embedding_width(const OnnxSession& session, const NetworkSpec& spec, int side) {
  const std::vector<float> grey(static_cast<std::size_t>(3 * side * side), 0.f);
  const TensorInput image = {spec.inputs.at("image"), {1, 3, side, side}, std::span(grey)};
  const TensorShape shape =
      session.run({&image, 1}, {&spec.outputs.at("embedding"), 1}).front().shape;
  if (shape.size() != 2 || shape[0] != 1)
    throw Error(concat("the image network answers ", to_text(shape), "; expected is [1,numbers]"));
  return shape[1];
}

/// Longest sequence that a text network was trained on; transformers leaves out what is a model's
/// default (SiglipTextConfig 64, CLIPTextConfig 77).
int context_length(const Json& config, const std::string& family) {
  constexpr int kSiglip = 64, kClip = 77;
  const int otherwise = family == "clip" ? kClip : kSiglip;
  const Json text = config.value("text_config", Json::object());
  return text.is_object() ? text.value("max_position_embeddings", otherwise) : otherwise;
}

std::string family_of(const fs::path& folder, const Json& config) {
  const std::string type = config.value("model_type", "");
  if (type == "siglip" || type == "clip") return type;
  throw Error(concat((folder / "config.json").string(), ": the model is of type '", type,
                     "'; accepted are siglip (also SigLIP 2 of a fixed resolution) and clip"));
}

void add_tokenizer_keys(const TokenizerFiles& tokens, int context, ModelDescription& model) {
  const bool clip = tokens.kind == "clip_bpe";
  auto& keys = model.keys;
  keys.emplace_back("tokenizer", tokens.kind);
  keys.emplace_back(clip ? "tokenizer_vocab" : "tokenizer_model", tokens.files.front());
  if (clip) keys.emplace_back("tokenizer_merges", tokens.files.back());
  keys.emplace_back("text_rule", tokens.text_rule);
  keys.emplace_back("lowercase", "true");  // all three were trained on lower case
  keys.emplace_back("context_length", std::to_string(context));
  keys.emplace_back("pad_to_context", "true");
  keys.emplace_back("pad_id", std::to_string(tokens.pad_id));
  if (tokens.begin_id) keys.emplace_back("bos_id", std::to_string(*tokens.begin_id));
  if (tokens.end_id) keys.emplace_back("eos_id", std::to_string(*tokens.end_id));
  model.written = tokens.files;
}

ModelDescription describe_encoder(const fs::path& folder, const FetchTarget& target) {
  const Json config = read_json(folder / "config.json", kSmallDocument);
  const std::string family = family_of(folder, config);
  ModelDescription model;
  model.input = read_image_processor(folder / "preprocessor_config.json");
  const std::string &image_file = target.files.at("image"), &text_file = target.files.at("text");
  {
    const OnnxSession image(folder / image_file, {});
    model.networks["image"] =
        network_spec(folder, image_file, image, {{"pixel_values", "image"}},
                     {{"image_embeds", "embedding"}, {"pooler_output", "embedding"}});
    check_side(folder / image_file, image.input("pixel_values"), model.input.size_px);
    model.keys.emplace_back(
        "embedding_dim",
        std::to_string(embedding_width(image, model.networks["image"], model.input.size_px)));
  }
  const OnnxSession text(folder / text_file, {});
  // SigLIP was trained to read the padding too, so where its export asks, nothing is masked.
  model.networks["text"] =
      network_spec(folder, text_file, text,
                   {{"input_ids", "ids"}, {"attention_mask", family == "clip" ? "mask" : "ones"}},
                   {{"text_embeds", "embedding"}, {"pooler_output", "embedding"}});
  add_tokenizer_keys(prepare_tokenizer(folder), context_length(config, family), model);
  model.keys.emplace_back("prompt_template",
                          family == "clip" ? "a photo of a {}." : "This is a photo of {}.");
  return model;
}

/// The two exports there are: SAM's, whose decoder adds the padding point and knows no corners of
/// boxes, and SAM 2's, whose decoder takes boxes apart and corners as points as well.
ModelDescription describe_sam(const fs::path& folder, const FetchTarget& target) {
  ModelDescription model;
  model.input = read_image_processor(folder / "preprocessor_config.json");
  const std::string &encoder_file = target.files.at("encoder"),
                    &decoder_file = target.files.at("decoder");
  const OnnxSession encoder(folder / encoder_file, {}), decoder(folder / decoder_file, {});
  Roles features;
  for (const TensorInfo& output : encoder.outputs())
    if (has(decoder.inputs(), output.name)) features.emplace_back(output.name, output.name);
  if (features.empty())
    throw Error(concat("network ", (folder / decoder_file).string(),
                       " takes nothing that the encoder gives (", names_of(encoder.outputs()),
                       ")"));
  model.networks["encoder"] =
      network_spec(folder, encoder_file, encoder, {{"pixel_values", "image"}}, features);
  check_side(folder / encoder_file, encoder.input("pixel_values"), model.input.size_px);
  Roles inputs = {{"input_points", "points"}, {"input_labels", "labels"}, {"input_boxes", "boxes"}};
  inputs.insert(inputs.end(), features.begin(), features.end());
  model.networks["decoder"] = network_spec(folder, decoder_file, decoder, inputs,
                                           {{"pred_masks", "masks"}, {"iou_scores", "scores"}});
  if (!model.networks["decoder"].inputs.contains("boxes")) {
    model.keys.emplace_back("box_corners", "false");
    model.keys.emplace_back("adds_padding", "true");
  }
  return model;
}

}  // namespace

ModelDescription describe_model(const fs::path& folder, const FetchTarget& target) {
  try {
    return target.entry.kind == "sam" ? describe_sam(folder, target)
                                      : describe_encoder(folder, target);
  } catch (const Json::exception& error) {
    throw Error(concat((folder / "config.json").string(), ": it is not what transformers writes (",
                       error.what(), ")"));
  }
}

}  // namespace ovimap
