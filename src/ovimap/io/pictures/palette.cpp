// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/pictures/palette.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include <Eigen/Core>

namespace ovimap {

namespace {

// Hue turns by the golden section; the other two steps were searched for the largest smallest
// distance among 40 and among 80 colours.
constexpr double kHueStep = 0.381966, kLightnessStep = 0.3391, kChromaStep = 0.2130;
constexpr double kPhase = 0.5;
constexpr double kDarkest = 0.45, kLightest = 0.88;
constexpr double kLeastChroma = 0.45;  // of the most that sRGB can show at that hue and lightness
constexpr double kMostChroma = 0.25;
constexpr Rgb8 kNoInstance = {170, 170, 170};

double fraction(double value) {
  return value - std::floor(value);
}

double encoded(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

Eigen::Vector3d linear_rgb(double lightness, double chroma, double hue) {
  const Eigen::Vector3d lab(lightness, chroma * std::cos(hue), chroma * std::sin(hue));
  const Eigen::Matrix3d cone_from_lab{{1, 0.3963377774, 0.2158037573},
                                      {1, -0.1055613458, -0.0638541728},
                                      {1, -0.0894841775, -1.2914855480}};
  const Eigen::Matrix3d rgb_from_cone{{4.0767416621, -3.3077115913, 0.2309699292},
                                      {-1.2684380046, 2.6097574011, -0.3413193965},
                                      {-0.0041960863, -0.7034186147, 1.7076147010}};
  return rgb_from_cone * (cone_from_lab * lab).array().cube().matrix();
}

/// The most chroma that sRGB can show there, by bisection.
double most_chroma(double lightness, double hue) {
  constexpr int kHalvings = 16;
  double shown = 0, not_shown = kMostChroma;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (shown + not_shown) / 2;
    const Eigen::Vector3d rgb = linear_rgb(lightness, middle, hue);
    (rgb.minCoeff() >= 0 && rgb.maxCoeff() <= 1 ? shown : not_shown) = middle;
  }
  return shown;
}

}  // namespace

Rgb8 instance_color(std::uint32_t id) {
  if (id == 0) return kNoInstance;
  const double hue = 2 * std::numbers::pi * fraction(id * kHueStep);
  const double lightness =
      kDarkest + (kLightest - kDarkest) * fraction(id * kLightnessStep + kPhase);
  const double vivid = kLeastChroma + (1 - kLeastChroma) * fraction(id * kChromaStep + kPhase);
  const Eigen::Vector3d rgb = linear_rgb(lightness, vivid * most_chroma(lightness, hue), hue);
  const auto byte = [](double linear) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(encoded(linear), 0.0, 1.0)));
  };
  return {byte(rgb.x()), byte(rgb.y()), byte(rgb.z())};
}

std::vector<std::array<std::uint8_t, 3>> instance_colors(std::span<const std::uint32_t> ids) {
  std::unordered_map<std::uint32_t, Rgb8> known;
  std::vector<std::array<std::uint8_t, 3>> colors;
  colors.reserve(ids.size());
  for (const std::uint32_t id : ids) {
    const auto [entry, is_new] = known.try_emplace(id);
    if (is_new) entry->second = instance_color(id);
    colors.push_back({entry->second.r, entry->second.g, entry->second.b});
  }
  return colors;
}

Rgb8 heat_color(float share) {
  constexpr std::array<std::array<float, 3>, 5> kStops{
      {{38, 40, 74}, {98, 44, 122}, {186, 58, 104}, {243, 128, 60}, {252, 232, 140}}};
  const float at = std::clamp(share, 0.f, 1.f) * (kStops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  const float weight = at - static_cast<float>(below);
  const auto channel = [&](std::size_t c) {
    const float value = kStops[below][c] + weight * (kStops[below + 1][c] - kStops[below][c]);
    return static_cast<std::uint8_t>(std::lround(value));
  };
  return {channel(0), channel(1), channel(2)};
}

}  // namespace ovimap
