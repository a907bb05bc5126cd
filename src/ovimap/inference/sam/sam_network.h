// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "ovimap/image/image.h"
#include "ovimap/inference/models/image_tensor.h"
#include "ovimap/inference/models/model_folder.h"
#include "ovimap/inference/models/onnx_session.h"

namespace ovimap {

/// Meaning of a prompt point, with the numbers that SAM-type decoders expect.
enum class PointLabel { kPadding = -1, kBackground = 0, kForeground = 1, kBoxMin = 2, kBoxMax = 3 };

struct PromptPoint {
  Eigen::Vector2f in_image_px;  ///< pixel centres at integers
  PointLabel label = PointLabel::kForeground;
};
using PromptPoints = std::vector<PromptPoint>;

/// What the decoder proposes for one prompt: `tokens` masks (whole, part, subpart, ...) as logits
/// on a small square grid over the network's input, and how good the network believes each to be.
struct MaskProposals {
  int tokens = 0, grid_size = 0;
  std::vector<float> logits;         ///< tokens x grid_size x grid_size, positive inside
  std::vector<float> predicted_iou;  ///< tokens
};

/// What the encoder says about one image; valid for the network that made it.
struct ImageFeatures {
  InputFrame frame;
  std::vector<FloatTensor> tensors;
};

/// A promptable segmentation network in two ONNX files: SAM, MobileSAM, EfficientSAM, SAM 2. Which
/// inputs there are, and whether prompts can be batched, is read from model.yaml and the files.
class SamNetwork {
 public:
  /// Throws Error when the model is not of kind sam, a file's digest or a tensor's name or shape is
  /// not what model.yaml says.
  SamNetwork(const ModelFolder& model, const RuntimeConfig& runtime);

  ImageFeatures encode(const RgbImage& image) const;

  /// One MaskProposals per prompt. All prompts must have the same number of points. Throws Error
  /// when the decoder fails.
  std::vector<MaskProposals> decode(const ImageFeatures& features,
                                    std::span<const PromptPoints> prompts) const;

  /// The encoder's output of the role "embedding"; the first one where none is called so.
  const FloatTensor& embedding(const ImageFeatures& features) const;

  /// Side of the decoder's square logit masks, in its pixels.
  int grid_size() const { return grid_size_; }
  int input_size_px() const { return input_.size_px; }

 private:
  void check_tensors(const ModelFolder& model);
  void read_prompt_rules(const ModelFolder& model);
  std::vector<PromptPoints> as_decoder_takes(std::span<const PromptPoints> prompts) const;
  std::vector<MaskProposals> decode_batch(const ImageFeatures& features,
                                          std::span<const PromptPoints> prompts) const;

  std::filesystem::path folder_;
  ImageInputSpec input_;
  NetworkSpec encoder_spec_, decoder_spec_;
  OnnxSession encoder_, decoder_;
  std::vector<std::string> feature_roles_;    ///< encoder outputs that the decoder wants
  std::vector<std::string> feature_outputs_;  ///< their names in the encoder
  int grid_size_ = 0;
  bool batches_ = false;       ///< the number of prompts is open
  bool nested_ = false;        ///< points are [1, prompts, points, 2], as EfficientSAM has them
  bool box_corners_ = true;    ///< the decoder knows the labels of box corners
  bool adds_padding_ = false;  ///< the decoder adds the padding point itself
};

}  // namespace ovimap
