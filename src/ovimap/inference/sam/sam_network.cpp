// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/sam_network.h"

#include <algorithm>
#include <numeric>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

// Roles of model.yaml's tensors.
constexpr const char* kImageInput = "image";
constexpr const char* kPoints = "points";
constexpr const char* kLabels = "labels";
constexpr const char* kBoxes = "boxes";
constexpr const char* kMaskInput = "mask_input";
constexpr const char* kHasMaskInput = "has_mask_input";
constexpr const char* kImageSize = "image_size";
constexpr const char* kMasks = "masks";
constexpr const char* kScores = "scores";

[[noreturn]] void wrong_shape(const std::filesystem::path& folder, const TensorInfo& tensor,
                              const std::string& expected) {
  throw Error(concat("model ", folder.string(), ": tensor '", tensor.name, "' has shape ",
                     to_text(tensor.shape), ", expected ", expected,
                     "; correct model.yaml or export the network again"));
}

std::int64_t element_count(const TensorShape& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::int64_t{1}, std::multiplies<>());
}

}  // namespace

SamNetwork::SamNetwork(const ModelFolder& model, const RuntimeConfig& runtime)
    : folder_(checked_model(model, "sam", "as a promptable network").folder),
      input_(model.input),
      encoder_spec_(model.network("encoder")),
      decoder_spec_(model.network("decoder")),
      encoder_(model, "encoder", runtime),
      decoder_(model, "decoder", runtime) {
  check_tensors(model);
  read_prompt_rules(model);
}

void SamNetwork::check_tensors(const ModelFolder& model) {
  const TensorInfo& image = encoder_.input(model.input_of("encoder", kImageInput));
  const TensorShape& shape = image.shape;
  const auto fits = [this](std::int64_t size) {
    return size == kAnySize || size == input_.size_px;
  };
  const bool any_rows = input_.row_step_px > 0;
  if (shape.size() != 4 || shape[1] != 3 || !fits(shape[2]) || !fits(shape[3]) ||
      (any_rows && shape[2] != kAnySize))
    wrong_shape(folder_, image,
                concat("[any,3,", any_rows ? "any" : std::to_string(input_.size_px), ",",
                       input_.size_px, "]"));

  for (const auto& [role, name] : encoder_spec_.outputs) {
    encoder_.output(name);
    if (!decoder_spec_.inputs.contains(role)) continue;
    feature_roles_.push_back(role);
    feature_outputs_.push_back(name);
  }
  if (feature_roles_.empty())
    throw Error(concat("model ", folder_.string(),
                       ": no output role of networks.encoder is an input role ",
                       "of networks.decoder; name the embedding in both"));

  for (const auto& [role, name] : decoder_spec_.inputs) decoder_.input(name);
  for (const char* role : {kMasks, kScores}) decoder_.output(model.output_of("decoder", role));
  const TensorInfo& points = decoder_.input(model.input_of("decoder", kPoints));
  decoder_.input(model.input_of("decoder", kLabels));
  nested_ = points.shape.size() == 4;
  if ((points.shape.size() != 3 && !nested_) || points.shape.back() != 2)
    wrong_shape(folder_, points, "[prompts,points,2] or [1,prompts,points,2]");
  batches_ = points.shape[nested_ ? 1 : 0] == kAnySize;
  // SAM-type decoders end at a quarter of the input's resolution; image_size asks for it where
  // needed.
  constexpr int kInputPerGrid = 4;
  const TensorShape& masks = decoder_.output(model.output_of("decoder", kMasks)).shape;
  const bool fixed = !masks.empty() && masks.back() != kAnySize;
  grid_size_ = fixed ? static_cast<int>(masks.back()) : input_.size_px / kInputPerGrid;
}

void SamNetwork::read_prompt_rules(const ModelFolder& model) {
  const auto flag = [&model](const char* key, bool otherwise) {
    const auto found = model.extras.find(key);
    if (found == model.extras.end()) return otherwise;
    if (found->second != "true" && found->second != "false")
      throw Error(concat("model file ", (model.folder / "model.yaml").string(), ": '", key,
                         "' is '", found->second, "'; accepted is true or false"));
    return found->second == "true";
  };
  box_corners_ = flag("box_corners", true);
  adds_padding_ = flag("adds_padding", false);
}

/// Without corners a box is asked for by its point alone.
std::vector<PromptPoints> SamNetwork::as_decoder_takes(
    std::span<const PromptPoints> prompts) const {
  std::vector<PromptPoints> taken(prompts.begin(), prompts.end());
  for (PromptPoints& prompt : taken) {
    const std::size_t before = prompt.size();
    if (!box_corners_)
      std::erase_if(prompt, [](const PromptPoint& point) {
        return point.label == PointLabel::kBoxMin || point.label == PointLabel::kBoxMax;
      });
    if (prompt.size() < before) prompt.push_back({{0, 0}, PointLabel::kPadding});
    if (adds_padding_)
      std::erase_if(prompt,
                    [](const PromptPoint& point) { return point.label == PointLabel::kPadding; });
  }
  return taken;
}

ImageFeatures SamNetwork::encode(const RgbImage& image) const {
  const FloatTensor tensor = image_tensor(image, input_);
  const std::vector<TensorInput> inputs = {
      {encoder_spec_.inputs.at(kImageInput), tensor.shape, std::span<const float>(tensor.values)}};
  return {input_frame(image.width(), image.height(), input_),
          encoder_.run(inputs, feature_outputs_)};
}

const FloatTensor& SamNetwork::embedding(const ImageFeatures& features) const {
  const auto found = std::find(feature_roles_.begin(), feature_roles_.end(), "embedding");
  const auto place = found == feature_roles_.end() ? 0 : found - feature_roles_.begin();
  return features.tensors[static_cast<std::size_t>(place)];
}

std::vector<MaskProposals> SamNetwork::decode(const ImageFeatures& features,
                                              std::span<const PromptPoints> prompts) const {
  if (batches_) return decode_batch(features, prompts);
  std::vector<MaskProposals> proposals;
  for (std::size_t i = 0; i < prompts.size(); ++i)
    proposals.push_back(std::move(decode_batch(features, prompts.subspan(i, 1)).front()));
  return proposals;
}

namespace {

struct PointTensors {
  TensorShape points_shape, labels_shape;
  std::vector<float> points, labels;
  std::vector<std::int64_t> label_numbers;  ///< the same labels
};

PointTensors point_tensors(std::span<const PromptPoints> prompts, const InputFrame& frame,
                           bool nested) {
  const auto count = static_cast<std::int64_t>(prompts.size());
  const auto points = static_cast<std::int64_t>(prompts.front().size());
  PointTensors tensors{{count, points, 2}, {count, points}, {}, {}, {}};
  if (nested) {
    tensors.points_shape.insert(tensors.points_shape.begin(), 1);
    tensors.labels_shape.insert(tensors.labels_shape.begin(), 1);
  }
  for (const PromptPoints& prompt : prompts) {
    OVIMAP_ASSERT(prompt.size() == prompts.front().size());
    for (const PromptPoint& point : prompt) {
      // SAM's coordinates are pixel corners scaled; its decoder adds the half pixel itself.
      const Eigen::Vector2f in_input = point.in_image_px.cwiseProduct(frame.scale);
      tensors.points.insert(tensors.points.end(), {in_input.x(), in_input.y()});
      tensors.labels.push_back(static_cast<float>(point.label));
      tensors.label_numbers.push_back(static_cast<std::int64_t>(point.label));
    }
  }
  return tensors;
}

/// Inputs of the usual SAM signature that are constant here: no mask from before, a small output.
class ConstantInputs {
 public:
  ConstantInputs(const OnnxSession& decoder, const NetworkSpec& spec, int grid_size)
      : size_float_(2, static_cast<float>(grid_size)),
        size_int64_(2, grid_size),
        size_int32_(2, grid_size) {
    add_zeros(decoder, spec, kMaskInput, mask_);
    add_zeros(decoder, spec, kHasMaskInput, has_mask_);
    if (const auto found = spec.inputs.find(kImageSize); found != spec.inputs.end())
      add_size(decoder.input(found->second));
    constexpr std::int64_t kBoxNumbers = 4;  // boxes are given as points: here there is none
    if (const auto found = spec.inputs.find(kBoxes); found != spec.inputs.end())
      inputs_.push_back(
          {found->second, {1, 0, kBoxNumbers}, std::span<const float>(size_float_).first(0)});
  }
  const std::vector<TensorInput>& inputs() const { return inputs_; }

 private:
  void add_zeros(const OnnxSession& decoder, const NetworkSpec& spec, const char* role,
                 std::vector<float>& storage) {
    const auto found = spec.inputs.find(role);
    if (found == spec.inputs.end()) return;
    TensorShape shape = decoder.input(found->second).shape;
    std::replace(shape.begin(), shape.end(), kAnySize, std::int64_t{1});
    storage.assign(static_cast<std::size_t>(element_count(shape)), 0.f);
    inputs_.push_back({found->second, shape, std::span<const float>(storage)});
  }
  void add_size(const TensorInfo& info) {
    TensorInput input{info.name, {2}, std::span<const float>(size_float_)};
    if (info.type == TensorType::kInt64) input.values = std::span<const std::int64_t>(size_int64_);
    if (info.type == TensorType::kInt32) input.values = std::span<const std::int32_t>(size_int32_);
    inputs_.push_back(input);
  }

  std::vector<float> mask_, has_mask_, size_float_;
  std::vector<std::int64_t> size_int64_;
  std::vector<std::int32_t> size_int32_;
  std::vector<TensorInput> inputs_;
};

std::vector<MaskProposals> split_proposals(const std::filesystem::path& folder,
                                           const FloatTensor& masks, const FloatTensor& scores,
                                           std::size_t prompts, int grid_size) {
  const std::size_t tokens = scores.values.size() / prompts;
  const auto grid = static_cast<std::size_t>(grid_size);
  if (tokens == 0 || masks.values.size() != prompts * tokens * grid * grid)
    throw Error(concat("model ", folder.string(), ": masks ", to_text(masks.shape), " and scores ",
                       to_text(scores.shape), " do not fit; expected are masks of ", grid, "x",
                       grid, " logits, as many as scores"));
  std::vector<MaskProposals> proposals(prompts);
  for (std::size_t i = 0; i < prompts; ++i) {
    const std::size_t size = tokens * grid * grid;
    const auto logits = masks.values.begin() + static_cast<std::ptrdiff_t>(i * size);
    const auto iou = scores.values.begin() + static_cast<std::ptrdiff_t>(i * tokens);
    proposals[i] = {static_cast<int>(tokens),
                    grid_size,
                    {logits, logits + static_cast<std::ptrdiff_t>(size)},
                    {iou, iou + static_cast<std::ptrdiff_t>(tokens)}};
  }
  return proposals;
}

}  // namespace

std::vector<MaskProposals> SamNetwork::decode_batch(const ImageFeatures& features,
                                                    std::span<const PromptPoints> asked) const {
  if (asked.empty()) return {};
  const std::vector<PromptPoints> prompts = as_decoder_takes(asked);
  const PointTensors points = point_tensors(prompts, features.frame, nested_);
  const ConstantInputs constants(decoder_, decoder_spec_, grid_size_);
  std::vector<TensorInput> inputs = constants.inputs();
  for (std::size_t i = 0; i < feature_roles_.size(); ++i)
    inputs.push_back({decoder_spec_.inputs.at(feature_roles_[i]), features.tensors[i].shape,
                      std::span<const float>(features.tensors[i].values)});
  inputs.push_back(
      {decoder_spec_.inputs.at(kPoints), points.points_shape, std::span(points.points)});
  TensorInput labels = {decoder_spec_.inputs.at(kLabels), points.labels_shape,
                        std::span(points.labels)};
  if (decoder_.input(labels.name).type == TensorType::kInt64)
    labels.values = std::span<const std::int64_t>(points.label_numbers);
  inputs.push_back(labels);
  const std::vector<std::string> outputs = {decoder_spec_.outputs.at(kMasks),
                                            decoder_spec_.outputs.at(kScores)};
  const std::vector<FloatTensor> results = decoder_.run(inputs, outputs);
  return split_proposals(folder_, results[0], results[1], prompts.size(), grid_size_);
}

}  // namespace ovimap
