// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <span>

#include <Eigen/Core>

#include "ovimap/inference/models/image_tensor.h"

namespace ovimap {

/// The probability that a network's logit says.
inline float logistic(float logit) {
  return 1.f / (1.f + std::exp(-logit));
}

/// A network's square grid of mask logits over one image: grid pixel (gx, gy) has its centre at
/// image pixel (gx + 0.5) / scale - 0.5.
struct LogitGrid {
  int size = 0;                    ///< side of the square logit image
  int width = 0, height = 0;       ///< the part of it that the image fills
  Eigen::Vector2f scale = {1, 1};  ///< grid_from_image, per axis
  int image_width_px = 0, image_height_px = 0;

  float image_px_per_grid_px() const { return 1.f / (scale.x() * scale.y()); }
  Eigen::Vector2f from_image(const Eigen::Vector2f& in_image_px) const {
    return (in_image_px.array() + 0.5f) * scale.array() - 0.5f;
  }
  Eigen::Vector2f to_image(const Eigen::Vector2f& in_grid_px) const {
    return (in_grid_px.array() + 0.5f) / scale.array() - 0.5f;
  }
};

LogitGrid logit_grid(const InputFrame& frame, int input_size_px, int grid_size, int image_width_px,
                     int image_height_px);

/// The logits at one row of image pixels: bilinear, clamped at the edges of the part the image
/// fills.
class LogitRow {
 public:
  /// `logits` is size x size.
  LogitRow(std::span<const float> logits, const LogitGrid& grid, int image_y);
  float at(int image_x) const;

 private:
  const LogitGrid& grid_;
  const float* upper_;
  const float* lower_;
  float lower_weight_;
};

}  // namespace ovimap
