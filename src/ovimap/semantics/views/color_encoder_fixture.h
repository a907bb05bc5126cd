// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>

#include "ovimap/inference/encoders/image_text_encoder.h"

namespace ovimap {

/// An encoder whose space is the mean colour: images and the words "red", "green", "blue" meet
/// there. Other words are grey.
class ColorEncoder : public ImageTextEncoder {
 public:
  const EncoderIdentity& identity() const override { return identity_; }
  std::optional<MatchCalibration> calibration() const override { return std::nullopt; }

  Embeddings encode_images(std::span<const RgbImage> images) override {
    const std::lock_guard lock(mutex_);
    images_seen += static_cast<int>(images.size());
    Embeddings rows = Embeddings::Zero(static_cast<Eigen::Index>(images.size()), 3);
    for (std::size_t i = 0; i < images.size(); ++i) {
      Eigen::RowVector3f sum = Eigen::RowVector3f::Zero();
      for (const Rgb8& pixel : images[i]) sum += Eigen::RowVector3f(pixel.r, pixel.g, pixel.b);
      if (sum.norm() > 0.f) rows.row(static_cast<Eigen::Index>(i)) = sum.normalized();
    }
    return rows;
  }

  Embeddings encode_texts(std::span<const std::string> texts) override {
    Embeddings rows(static_cast<Eigen::Index>(texts.size()), 3);
    for (std::size_t i = 0; i < texts.size(); ++i) {
      Eigen::RowVector3f row(1, 1, 1);
      if (texts[i] == "red") row = {1, 0, 0};
      if (texts[i] == "green") row = {0, 1, 0};
      if (texts[i] == "blue") row = {0, 0, 1};
      rows.row(static_cast<Eigen::Index>(i)) = row.normalized();
    }
    return rows;
  }

  int images_seen = 0;

 private:
  EncoderIdentity identity_{"colours", 3, std::string(64, 'c')};
  std::mutex mutex_;
};

}  // namespace ovimap
