// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/image_tensor.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/parallel.h"
#include "ovimap/image/resize.h"

namespace ovimap {

namespace {

constexpr std::size_t kRowsPerTask = 32;

struct Affine {
  float scale, offset;
};

Affine normalisation(const ImageInputSpec& spec, std::size_t channel) {
  return {1.f / spec.std[channel], -spec.mean[channel] / spec.std[channel]};
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

FloatTensor image_tensor(const RgbImage& image, const ImageInputSpec& spec) {
  const InputFrame frame = input_frame(image.width(), image.height(), spec);
  const RgbImage resized = resize_bilinear(image, frame.width_px, frame.height_px);
  const auto size = static_cast<std::size_t>(spec.size_px);
  FloatTensor tensor{{1, 3, spec.size_px, spec.size_px}, std::vector<float>(3 * size * size, 0.f)};
  const Affine r = normalisation(spec, 0), g = normalisation(spec, 1), b = normalisation(spec, 2);
  parallel_for(static_cast<std::size_t>(frame.height_px), kRowsPerTask, [&](std::size_t y) {
    const Rgb8* from = resized.row(static_cast<int>(y));
    float* red = tensor.values.data() + y * size;
    float* green = red + size * size;
    float* blue = green + size * size;
    for (int x = 0; x < frame.width_px; ++x) {
      red[x] = static_cast<float>(from[x].r) * r.scale + r.offset;
      green[x] = static_cast<float>(from[x].g) * g.scale + g.offset;
      blue[x] = static_cast<float>(from[x].b) * b.scale + b.offset;
    }
  });
  return tensor;
}

}  // namespace ovimap
