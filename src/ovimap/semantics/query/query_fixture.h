// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "ovimap/inference/encoders/image_text_encoder.h"
#include "ovimap/semantics/query/search_index.h"

namespace ovimap {

/// An encoder without a network: every word is a random direction of its own (a plural that of its
/// singular), a text is the sum of its words, and the picture of a thing, made by picture_of, is
/// the text of it.
class WordEncoder : public ImageTextEncoder {
 public:
  static constexpr int kDimension = 128;

  const EncoderIdentity& identity() const override { return identity_; }
  std::optional<MatchCalibration> calibration() const override { return calibration_; }
  std::string prompt_template() const override { return template_; }

  Embeddings encode_images(std::span<const RgbImage> images) override {
    std::vector<std::string> texts;
    for (const RgbImage& image : images) {
      std::string text;
      for (const Rgb8 pixel : image) text += static_cast<char>(pixel.r);
      texts.push_back(text);
    }
    return encode_texts(texts);
  }

  Embeddings encode_texts(std::span<const std::string> texts) override {
    texts_encoded += static_cast<int>(texts.size());
    Embeddings rows(static_cast<Eigen::Index>(texts.size()), kDimension);
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
      rows.row(i) = direction_of(texts[static_cast<std::size_t>(i)]).transpose();
    return rows;
  }

  /// Length 1; the same direction for the same text on every machine of one standard library.
  static Eigen::VectorXf direction_of(const std::string& text) {
    Eigen::VectorXf sum = Eigen::VectorXf::Zero(kDimension);
    std::istringstream words(text);
    for (std::string word; words >> word;) {
      if (word.size() > 1 && word.back() == 's') word.pop_back();
      std::seed_seq seed(word.begin(), word.end());
      std::mt19937 engine(seed);
      std::normal_distribution<float> normal;
      sum += Eigen::VectorXf::NullaryExpr(kDimension, [&] { return normal(engine); }).normalized();
    }
    return sum.normalized();
  }

  static RgbImage picture_of(const std::string& thing) {
    RgbImage image(static_cast<int>(thing.size()), 1);
    for (std::size_t i = 0; i < thing.size(); ++i) image[i].r = static_cast<std::uint8_t>(thing[i]);
    return image;
  }

  EncoderIdentity identity_{"words", kDimension, ""};
  std::optional<MatchCalibration> calibration_;
  std::string template_ = "{}";
  int texts_encoded = 0;
};

/// A map of such things, ids 1, 2, ..., each seen with some noise. An empty name is an object
/// without embedding. Boxes are unit cubes in a row along x unless given.
inline SearchIndex map_of(const std::vector<std::string>& things,
                          const std::vector<Eigen::AlignedBox3f>& boxes = {}) {
  std::vector<SearchObject> objects(things.size());
  Embeddings rows(static_cast<Eigen::Index>(things.size()), WordEncoder::kDimension);
  std::mt19937 engine(17);
  std::normal_distribution<float> normal;
  for (std::size_t i = 0; i < things.size(); ++i) {
    const Eigen::VectorXf noise =
        Eigen::VectorXf::NullaryExpr(WordEncoder::kDimension, [&] { return normal(engine); });
    const Eigen::VectorXf row = things[i].empty()
                                    ? Eigen::VectorXf::Zero(WordEncoder::kDimension)
                                    : (WordEncoder::direction_of(things[i]) + 0.04f * noise).eval();
    rows.row(static_cast<Eigen::Index>(i)) = row.transpose();
    const Eigen::Vector3f corner(2.f * static_cast<float>(i), 0.f, 0.f);
    objects[i].id = static_cast<InstanceId>(i + 1);
    objects[i].box =
        boxes.empty() ? Eigen::AlignedBox3f(corner, corner + Eigen::Vector3f::Ones()) : boxes[i];
    objects[i].centroid = objects[i].box.center();
    objects[i].points = 1000;
  }
  return SearchIndex(std::move(objects), rows);
}

}  // namespace ovimap
