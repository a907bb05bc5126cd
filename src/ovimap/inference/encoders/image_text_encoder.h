// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "ovimap/image/image.h"
#include "ovimap/inference/models/onnx_session.h"

namespace ovimap {

/// One embedding a row, of length 1.
using Embeddings = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Which space embeddings live in: those of one identity can be compared, others cannot.
struct EncoderIdentity {
  std::string name;    ///< as model.yaml gives it
  int dimension = 0;   ///< of an embedding
  std::string digest;  ///< SHA-256 over the model's files, 64 hexadecimal digits
  bool operator==(const EncoderIdentity&) const = default;
};

/// How a model with a sigmoid loss turns a cosine into a probability:
/// 1 / (1 + exp(-(scale * cosine + bias))).
struct MatchCalibration {
  float scale = 1.f, bias = 0.f;
};

/// Puts images and texts into one space, where what belongs together is near (cosine). Calls are
/// thread-safe.
class ImageTextEncoder {
 public:
  virtual ~ImageTextEncoder() = default;

  virtual const EncoderIdentity& identity() const = 0;
  /// Absent where the model was not trained with a sigmoid loss.
  virtual std::optional<MatchCalibration> calibration() const = 0;
  /// What names and short queries are put into before they are encoded; {} stands for them.
  virtual std::string prompt_template() const { return "{}"; }

  /// [images, dimension]. The images may have any size. Throws Error when the network fails; a row
  /// that is not finite comes back as zeros, so that it cannot enter a map.
  virtual Embeddings encode_images(std::span<const RgbImage> images) = 0;
  /// [texts, dimension]. Long texts are cut at the model's context length.
  virtual Embeddings encode_texts(std::span<const std::string> texts) = 0;
  /// The same of a list of words that many questions need and that holds no question: such lists
  /// may be stored (text_cache.h).
  virtual Embeddings encode_vocabulary(std::span<const std::string> texts) {
    return encode_texts(texts);
  }
};

/// The name of the model that `default` stands for; tools/setup.sh puts it on the search path.
inline constexpr const char* kDefaultEncoder = "default-encoder";

/// The model that `auto` stands for: of the encoders on the search path the one with the greatest
/// `preference` whose self-test found nothing wrong; kDefaultEncoder where none has one.
std::string preferred_encoder(const std::vector<std::filesystem::path>& model_dirs);

/// What an encoder is wanted for. Its other half is opened when it is needed after all.
enum class EncoderUse { kImages, kTexts, kBoth };

/// The encoder that `spec` names: "none" (nullptr), "default", a model folder of kind dual_encoder,
/// or the name of one on the search path. Throws Error when there is no such thing or what `use`
/// needs of it does not load.
std::unique_ptr<ImageTextEncoder> make_image_text_encoder(
    const std::string& spec, const RuntimeConfig& runtime,
    const std::vector<std::filesystem::path>& model_dirs = {}, EncoderUse use = EncoderUse::kBoth);

}  // namespace ovimap
