// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/models/image_tensor.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"
#include "ovimap/image/resize.h"

namespace ovimap {

namespace {

constexpr std::size_t kTensorRowsPerTask = 32;

struct Affine {
  float scale, offset;
};

Affine normalisation(const ImageInputSpec& spec, std::size_t channel) {
  return {1.f / spec.std[channel], -spec.mean[channel] / spec.std[channel]};
}

/// The short side becomes `size_px`, the long one is rounded down, as is where the square is cut
/// from it: what the published preprocessing of CLIP does.
RgbImage centre_square(const RgbImage& image, const ImageInputSpec& spec) {
  const std::int64_t width = image.width(), height = image.height(), size = spec.size_px;
  const std::int64_t shorter = std::max<std::int64_t>(1, std::min(width, height));
  const auto new_width = static_cast<int>(width <= height ? size : size * width / shorter);
  const auto new_height = static_cast<int>(width <= height ? size * height / shorter : size);
  const ImageWindow square = {(new_width - spec.size_px) / 2, (new_height - spec.size_px) / 2,
                              spec.size_px, spec.size_px};
  return resize_window(image, new_width, new_height, square, spec.filter);
}

/// What enters the network's input, at its top left corner.
RgbImage resized(const RgbImage& image, const ImageInputSpec& spec) {
  if (spec.resize == ResizeRule::kShortSide) return centre_square(image, spec);
  const InputFrame frame = input_frame(image.width(), image.height(), spec);
  return resize_filtered(image, frame.width_px, frame.height_px, spec.filter);
}

/// Of the network's input.
int rows_for(const RgbImage& image, const ImageInputSpec& spec) {
  if (spec.row_step_px == 0 || spec.resize != ResizeRule::kLongSide) return spec.size_px;
  const InputFrame frame = input_frame(image.width(), image.height(), spec);
  const int steps = (frame.height_px + spec.rows_below_px - 1) / spec.row_step_px + 1;
  return std::min(steps * spec.row_step_px, spec.size_px);
}

}  // namespace

InputFrame input_frame(int image_width_px, int image_height_px, const ImageInputSpec& spec) {
  const auto size = static_cast<float>(spec.size_px);
  const auto width = static_cast<float>(image_width_px),
             height = static_cast<float>(image_height_px);
  InputFrame frame{spec.size_px, spec.size_px, {size / width, size / height}};
  if (spec.resize == ResizeRule::kLongSide) {
    const float scale = size / std::max(width, height);
    frame.width_px = std::clamp(static_cast<int>(std::lround(width * scale)), 1, spec.size_px);
    frame.height_px = std::clamp(static_cast<int>(std::lround(height * scale)), 1, spec.size_px);
    frame.scale = {scale, scale};
  }
  return frame;
}

void write_image_tensor(const RgbImage& image, const ImageInputSpec& spec,
                        std::span<float> values) {
  const RgbImage pixels = resized(image, spec);
  const auto size = static_cast<std::size_t>(spec.size_px);
  const std::size_t plane = values.size() / 3;
  OVIMAP_ASSERT(plane >= static_cast<std::size_t>(pixels.height()) * size);
  std::fill(values.begin(), values.end(), 0.f);
  const Affine r = normalisation(spec, 0), g = normalisation(spec, 1), b = normalisation(spec, 2);
  parallel_for(static_cast<std::size_t>(pixels.height()), kTensorRowsPerTask, [&](std::size_t y) {
    const Rgb8* from = pixels.row(static_cast<int>(y));
    float* red = values.data() + y * size;
    float* green = red + plane;
    float* blue = green + plane;
    for (int x = 0; x < pixels.width(); ++x) {
      red[x] = static_cast<float>(from[x].r) * r.scale + r.offset;
      green[x] = static_cast<float>(from[x].g) * g.scale + g.offset;
      blue[x] = static_cast<float>(from[x].b) * b.scale + b.offset;
    }
  });
}

FloatTensor image_tensor(const RgbImage& image, const ImageInputSpec& spec) {
  const int rows = rows_for(image, spec);
  const auto values = 3 * static_cast<std::size_t>(rows) * static_cast<std::size_t>(spec.size_px);
  FloatTensor tensor{{1, 3, rows, spec.size_px}, std::vector<float>(values)};
  write_image_tensor(image, spec, tensor.values);
  return tensor;
}

}  // namespace ovimap
