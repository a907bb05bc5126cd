// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/encoders/dual_encoder.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "ovimap/base/error.h"
#include "ovimap/inference/models/image_tensor.h"
#include "ovimap/inference/text/text_input.h"

namespace ovimap {

namespace {

constexpr const char* kImage = "image";
constexpr const char* kText = "text";
constexpr const char* kEmbedding = "embedding";
// Texts that take longer with converted weights than to convert them: 0.2 s against 0.02 s each.
constexpr std::size_t kFewTexts = 8;

/// The image network and the weights beside it; all other files belong to the text.
bool is_image_file(const ModelFolder& model, const std::string& file) {
  const std::vector<std::string> of_image = model.network(kImage).files();
  return std::any_of(of_image.begin(), of_image.end(),
                     [&](const std::string& name) { return file.starts_with(name); });
}

[[noreturn]] void network_fault(const ModelFolder& model, const std::string& what) {
  throw Error(concat("model ", model.folder.string(), ": ", what,
                     "; export the network again or correct model.yaml"));
}

/// Where `expected` has kAnySize anything is accepted; where the network has it, too.
void check_tensor(const ModelFolder& model, const TensorInfo& tensor, TensorType type,
                  const char* type_name, const TensorShape& expected) {
  bool fits = tensor.shape.size() == expected.size();
  for (std::size_t i = 0; fits && i < expected.size(); ++i)
    fits = tensor.shape[i] < 0 || expected[i] < 0 || tensor.shape[i] == expected[i];
  if (!fits || tensor.type != type)
    network_fault(model, concat("tensor ", tensor.name, " has shape ", to_text(tensor.shape),
                                tensor.type == type ? "" : " and another type", ", expected ",
                                type_name, " ", to_text(expected)));
}

/// How many items one run may take.
std::size_t check_batch(const ModelFolder& model, const TensorInfo& input, int items_at_once) {
  if (input.shape[0] > 1)
    network_fault(model, concat("tensor ", input.name, " takes exactly ", input.shape[0],
                                " items at a time; any number, or 1, is accepted"));
  return input.shape[0] == 1 ? 1 : static_cast<std::size_t>(items_at_once);
}

/// Every input the network wants must be one we feed.
void check_inputs_known(const ModelFolder& model, const OnnxSession& session, const char* network) {
  const auto& known = model.network(network).inputs;
  for (const TensorInfo& input : session.inputs())
    if (std::none_of(known.begin(), known.end(),
                     [&input](const auto& entry) { return entry.second == input.name; }))
      network_fault(model, concat("network ", network, " wants an input ", input.name,
                                  ", which model.yaml does not give a role"));
}

std::size_t check_image_network(const ModelFolder& model, const OnnxSession& session,
                                const DualEncoderSpec& spec) {
  const std::int64_t size = model.input.size_px;
  const TensorInfo& input = session.input(model.input_of(kImage, kImage));
  check_inputs_known(model, session, kImage);
  check_tensor(model, input, TensorType::kFloat, "float32", {kAnySize, 3, size, size});
  check_tensor(model, session.output(model.output_of(kImage, kEmbedding)), TensorType::kFloat,
               "float32", {kAnySize, spec.dimension});
  return check_batch(model, input, spec.items_at_once);
}

std::size_t check_text_network(const ModelFolder& model, const OnnxSession& session,
                               const DualEncoderSpec& spec) {
  const TensorInfo& ids = session.input(model.input_of(kText, "ids"));
  check_inputs_known(model, session, kText);
  for (const auto& [role, name] : model.network(kText).inputs) {
    if (role != "ids" && role != "mask" && role != "ones" && role != "types")
      network_fault(model, concat("'networks.text.inputs.", role,
                                  "' is no role; accepted is ids, mask, ", "ones or types"));
    check_tensor(model, session.input(name), TensorType::kInt64, "int64",
                 {kAnySize, spec.text.pad_to_context ? spec.text.context_length : kAnySize});
  }
  if (ids.shape[1] > 0 && !spec.text.pad_to_context)
    network_fault(model, concat("tensor ", ids.name, " takes exactly ", ids.shape[1],
                                " ids, but 'pad_to_context' is not true"));
  check_tensor(model, session.output(model.output_of(kText, kEmbedding)), TensorType::kFloat,
               "float32", {kAnySize, spec.dimension});
  // Without padding texts run alone, so that none changes with its neighbours: quantised networks
  // scale by all they are given at once.
  const std::size_t at_once = check_batch(model, ids, spec.items_at_once);
  return spec.text.pad_to_context ? at_once : 1;
}

/// Makes the row's length 1; one that is zero or not finite becomes zeros.
void normalise(std::span<float> row) {
  double square = 0;
  for (const float value : row) square += static_cast<double>(value) * value;
  const double scale = square > 0 && std::isfinite(square) ? 1 / std::sqrt(square) : 0.0;
  for (float& value : row) value = scale > 0 ? static_cast<float>(value * scale) : 0.f;
}

/// Calls `body(items, rows)` for each batch.
template <class Item, class Body>
Embeddings in_batches(std::span<const Item> items, std::size_t at_once, int dimension,
                      const Body& body) {
  Embeddings rows(static_cast<Eigen::Index>(items.size()), dimension);
  const auto width = static_cast<std::size_t>(dimension);
  for (std::size_t begin = 0; begin < items.size(); begin += at_once) {
    const std::size_t count = std::min(at_once, items.size() - begin);
    const std::span<float> part(rows.data() + begin * width, count * width);
    body(items.subspan(begin, count), part);
    for (std::size_t i = 0; i < count; ++i) normalise(part.subspan(i * width, width));
  }
  return rows;
}

}  // namespace

DualEncoder::DualEncoder(const ModelFolder& model, const RuntimeConfig& runtime, EncoderUse use)
    : model_(model),
      spec_(read_dual_encoder_spec(model)),
      identity_{model.name, spec_.dimension, model.digest()},
      runtime_(runtime) {
  if (use != EncoderUse::kTexts) images();
  if (use != EncoderUse::kImages) texts(SessionUse::kFewRuns);
}

DualEncoder::Network& DualEncoder::images() {
  std::call_once(images_.opened, [this] {
    verify_model_files(model_, [this](const auto& file) { return is_image_file(model_, file); });
    images_.session.emplace(model_, kImage, runtime_);
    images_.at_once = check_image_network(model_, *images_.session, spec_);
  });
  return images_;
}

DualEncoder::Network& DualEncoder::texts(SessionUse use) {
  std::call_once(text_files_, [this] {
    verify_model_files(model_, [this](const auto& file) { return !is_image_file(model_, file); });
    tokenizer_ = open_tokenizer(model_, spec_.text);
  });
  Network& network = use == SessionUse::kFewRuns ? few_texts_ : texts_;
  std::call_once(network.opened, [&] {
    network.session.emplace(model_, kText, runtime_, use);
    network.at_once = check_text_network(model_, *network.session, spec_);
  });
  return network;
}

SessionUse DualEncoder::use_of(std::size_t count) {
  return (texts_asked_ += count) > kFewTexts ? SessionUse::kManyRuns : SessionUse::kFewRuns;
}

Embeddings DualEncoder::encode_images(std::span<const RgbImage> images) {
  return in_batches(images, this->images().at_once, spec_.dimension,
                    [this](auto items, auto rows) { run_images(items, rows); });
}

Embeddings DualEncoder::encode_texts(std::span<const std::string> texts) {
  const Network& network = this->texts(use_of(texts.size()));
  return in_batches(texts, network.at_once, spec_.dimension,
                    [&](auto items, auto rows) { run_texts(*network.session, items, rows); });
}

void DualEncoder::run_images(std::span<const RgbImage> images, std::span<float> rows) {
  const std::int64_t size = model_.input.size_px;
  const auto values = static_cast<std::size_t>(3 * size * size);
  std::vector<float> pixels(images.size() * values);
  for (std::size_t i = 0; i < images.size(); ++i)
    write_image_tensor(images[i], model_.input, std::span(pixels).subspan(i * values, values));
  const TensorInput input = {model_.input_of(kImage, kImage),
                             {static_cast<std::int64_t>(images.size()), 3, size, size},
                             std::span<const float>(pixels)};
  run(*images_.session, kImage, {&input, 1}, rows);
}

void DualEncoder::run_texts(const OnnxSession& session, std::span<const std::string> texts,
                            std::span<float> rows) const {
  const IdBatch batch = make_id_batch(texts, spec_.text, *tokenizer_);
  std::vector<TensorInput> inputs;
  const std::vector<std::int64_t> ones(batch.ids.size(), 1);
  const std::map<std::string, std::span<const std::int64_t>> by_role = {
      {"ids", batch.ids}, {"mask", batch.mask}, {"ones", ones}, {"types", batch.types}};
  for (const auto& [role, name] : model_.network(kText).inputs) {
    const std::span<const std::int64_t> values = by_role.at(role);
    inputs.push_back({name, batch.shape, values});
  }
  run(session, kText, inputs, rows);
}

void DualEncoder::run(const OnnxSession& session, const std::string& network,
                      std::span<const TensorInput> inputs, std::span<float> rows) const {
  const std::string& output = model_.output_of(network, kEmbedding);
  const std::vector<FloatTensor> results = session.run(inputs, {&output, 1});
  const TensorShape expected = {inputs[0].shape[0], spec_.dimension};
  if (results[0].shape != expected)
    network_fault(model_, concat("network ", network, " gave embeddings of shape ",
                                 to_text(results[0].shape), ", expected ", to_text(expected)));
  std::copy(results[0].values.begin(), results[0].values.end(), rows.begin());
}

}  // namespace ovimap
