// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/masks/logit_grid.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

struct Interpolation {
  int first, second;
  float second_weight;
};

Interpolation interpolation(float at, int count) {
  const float clamped = std::clamp(at, 0.f, static_cast<float>(count - 1));
  const int first = static_cast<int>(clamped);
  return {first, std::min(first + 1, count - 1), clamped - static_cast<float>(first)};
}

}  // namespace

LogitGrid logit_grid(const InputFrame& frame, int input_size_px, int grid_size, int image_width_px,
                     int image_height_px) {
  const float ratio = static_cast<float>(grid_size) / static_cast<float>(input_size_px);
  const auto filled = [ratio, grid_size](int input_px) {
    return std::clamp(static_cast<int>(std::ceil(static_cast<float>(input_px) * ratio)), 1,
                      grid_size);
  };
  return {grid_size,           filled(frame.width_px), filled(frame.height_px),
          frame.scale * ratio, image_width_px,         image_height_px};
}

LogitRow::LogitRow(std::span<const float> logits, const LogitGrid& grid, int image_y)
    : grid_(grid) {
  const auto size = static_cast<std::size_t>(grid.size);
  OVIMAP_ASSERT(logits.size() == size * size);
  const float y = (static_cast<float>(image_y) + 0.5f) * grid.scale.y() - 0.5f;
  const Interpolation rows = interpolation(y, grid.height);
  upper_ = logits.data() + static_cast<std::size_t>(rows.first) * size;
  lower_ = logits.data() + static_cast<std::size_t>(rows.second) * size;
  lower_weight_ = rows.second_weight;
}

float LogitRow::at(int image_x) const {
  const float x = (static_cast<float>(image_x) + 0.5f) * grid_.scale.x() - 0.5f;
  const Interpolation columns = interpolation(x, grid_.width);
  const float top = upper_[columns.first] +
                    columns.second_weight * (upper_[columns.second] - upper_[columns.first]);
  const float bottom = lower_[columns.first] +
                       columns.second_weight * (lower_[columns.second] - lower_[columns.first]);
  return top + lower_weight_ * (bottom - top);
}

}  // namespace ovimap
