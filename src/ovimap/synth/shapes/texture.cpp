// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/shapes/texture.h"

#include <algorithm>
#include <cmath>

namespace ovimap {
namespace {

std::array<float, 256> linear_table() {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const float value = static_cast<float>(i) / 255.f;
    table[i] = value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
  }
  return table;
}

/// The mean of each 2x2 block; odd last rows and columns are dropped.
RgbImage halved(const RgbImage& image) {
  RgbImage half(std::max(1, image.width() / 2), std::max(1, image.height() / 2));
  for (int y = 0; y < half.height(); ++y)
    for (int x = 0; x < half.width(); ++x) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int corner = 0; corner < 4; ++corner)
        sum += linear_from_srgb(image.at(std::min(2 * x + corner % 2, image.width() - 1),
                                         std::min(2 * y + corner / 2, image.height() - 1)));
      half.at(x, y) = srgb_from_linear(sum / 4);
    }
  return half;
}

}  // namespace

float linear_from_srgb(std::uint8_t value) {
  static const std::array<float, 256> table = linear_table();
  return table[value];
}

std::uint8_t srgb_from_linear(float value) {
  // The curve is sampled once: 4096 steps resolve all 256 values except in the first few darkest
  // ones.
  constexpr int kSteps = 4096;
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> made(kSteps + 1);
    for (int i = 0; i <= kSteps; ++i) {
      const float x = static_cast<float>(i) / kSteps;
      const float y = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
      made[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(255 * y));
    }
    return made;
  }();
  return table[static_cast<std::size_t>(std::clamp(value, 0.f, 1.f) * kSteps + 0.5f)];
}

Eigen::Vector3f linear_from_srgb(Rgb8 color) {
  return {linear_from_srgb(color.r), linear_from_srgb(color.g), linear_from_srgb(color.b)};
}

Rgb8 srgb_from_linear(const Eigen::Vector3f& color) {
  return {srgb_from_linear(color.x()), srgb_from_linear(color.y()), srgb_from_linear(color.z())};
}

Texture::Texture(RgbImage image) {
  levels_.push_back(std::move(image));
  while (std::max(levels_.back().width(), levels_.back().height()) > 1)
    levels_.push_back(halved(levels_.back()));
}

Eigen::Vector3f Texture::sample(const Eigen::Vector2f& uv, float footprint_px) const {
  const float wanted = std::log2(std::max(1.f, footprint_px));
  const auto last = static_cast<float>(levels_.size() - 1);
  const RgbImage& level = levels_[static_cast<std::size_t>(std::min(wanted + 0.5f, last))];
  const float x = (uv.x() - std::floor(uv.x())) * static_cast<float>(level.width()) - 0.5f;
  const float v = 1 - uv.y();
  const float y = (v - std::floor(v)) * static_cast<float>(level.height()) - 0.5f;
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  const float right_part = x - static_cast<float>(left), low_part = y - static_cast<float>(top);
  const int x0 = wrapped_index(left, level.width()), x1 = wrapped_index(left + 1, level.width());
  const int y0 = wrapped_index(top, level.height()), y1 = wrapped_index(top + 1, level.height());
  const Eigen::Vector3f upper = linear_from_srgb(level.at(x0, y0)) * (1 - right_part) +
                                linear_from_srgb(level.at(x1, y0)) * right_part;
  const Eigen::Vector3f lower = linear_from_srgb(level.at(x0, y1)) * (1 - right_part) +
                                linear_from_srgb(level.at(x1, y1)) * right_part;
  return upper * (1 - low_part) + lower * low_part;
}

}  // namespace ovimap
