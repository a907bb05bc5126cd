// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/shapes/painting.h"

#include <algorithm>

#include "ovimap/base/parallel.h"

namespace ovimap {
namespace {

constexpr std::size_t kPaintedRowsPerTask = 16;
constexpr int kRepeatSide_px = 1024;
constexpr float kRepeatSide_m = 2.56f;
constexpr float kPictureResolution_px_m = 400;

float eased(float t) {
  return t * t * (3 - 2 * t);
}

/// std::floor is a call where processors of before SSE4.1 are served.
int floor_of(float x) {
  const int towards_zero = static_cast<int>(x);
  return towards_zero - (static_cast<float>(towards_zero) > x ? 1 : 0);
}

}  // namespace

float smooth_step(float low, float high, float x) {
  return eased(std::clamp((x - low) / (high - low), 0.f, 1.f));
}

float LatticeNoise::at(float x, float y, int period_x, int period_y) const {
  const int column = floor_of(x), row = floor_of(y);
  const float u = eased(x - static_cast<float>(column));
  const float v = eased(y - static_cast<float>(row));
  // Most of the time of a room's textures goes here, so that divisions count.
  const int left = wrapped_index(column, period_x), right = left + 1 == period_x ? 0 : left + 1;
  const int top = wrapped_index(row, period_y), bottom = top + 1 == period_y ? 0 : top + 1;
  const auto corner = [this](int cell_x, int cell_y) {
    const auto cell = static_cast<std::uint64_t>(cell_x) << 32 | static_cast<std::uint64_t>(cell_y);
    return static_cast<float>(mix_bits(seed_ ^ mix_bits(cell)) >> 40) * 0x1p-24f;
  };
  const float upper = corner(left, top) * (1 - u) + corner(right, top) * u;
  const float lower = corner(left, bottom) * (1 - u) + corner(right, bottom) * u;
  return upper * (1 - v) + lower * v;
}

std::shared_ptr<const Texture> painted(int width, int height, const Paint& color_at) {
  RgbImage image(width, height);
  parallel_for(static_cast<std::size_t>(height), kPaintedRowsPerTask, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      const PaintColor color =
          color_at((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                   (static_cast<float>(y) + 0.5f) / static_cast<float>(height));
      const auto byte = [&](int i) {
        return static_cast<std::uint8_t>(std::clamp(color[i], 0.f, 1.f) * 255 + 0.5f);
      };
      image.at(x, y) = {byte(0), byte(1), byte(2)};
    }
  });
  return std::make_shared<Texture>(std::move(image));
}

SurfacePattern repeating(const Paint& color_at) {
  return {painted(kRepeatSide_px, kRepeatSide_px, color_at), kRepeatSide_m, kRepeatSide_m};
}

SurfacePattern picture(float width_m, float height_m, const Paint& color_at) {
  const auto pixels = [](float metres) {
    return std::max(8, static_cast<int>(metres * kPictureResolution_px_m));
  };
  return {painted(pixels(width_m), pixels(height_m), color_at), width_m, height_m};
}

}  // namespace ovimap
