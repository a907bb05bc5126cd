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

}  // namespace

float smooth_step(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

float LatticeNoise::at(float x, float y, int period_x, int period_y) const {
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  const float u = smooth_step(0, 1, x - static_cast<float>(left));
  const float v = smooth_step(0, 1, y - static_cast<float>(top));
  const auto corner = [&](int dx, int dy) {
    const auto wrap = [](int i, int period) { return ((i % period) + period) % period; };
    const auto cell = static_cast<std::uint64_t>(wrap(left + dx, period_x)) << 32 |
                      static_cast<std::uint64_t>(wrap(top + dy, period_y));
    return static_cast<float>(mix_bits(seed_ ^ mix_bits(cell)) >> 40) * 0x1p-24f;
  };
  const float upper = corner(0, 0) * (1 - u) + corner(1, 0) * u;
  const float lower = corner(0, 1) * (1 - u) + corner(1, 1) * u;
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
