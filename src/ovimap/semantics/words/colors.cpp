// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/colors.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

struct ColorWord {
  std::string_view word;
  Color color;
};
constexpr std::array kColorWords{
    ColorWord{"black", Color::kBlack},    ColorWord{"grey", Color::kGrey},
    ColorWord{"white", Color::kWhite},    ColorWord{"red", Color::kRed},
    ColorWord{"orange", Color::kOrange},  ColorWord{"yellow", Color::kYellow},
    ColorWord{"green", Color::kGreen},    ColorWord{"turquoise", Color::kTurquoise},
    ColorWord{"blue", Color::kBlue},      ColorWord{"purple", Color::kPurple},
    ColorWord{"pink", Color::kPink},      ColorWord{"brown", Color::kBrown},
    ColorWord{"beige", Color::kBeige},    ColorWord{"gray", Color::kGrey},
    ColorWord{"silver", Color::kGrey},    ColorWord{"violet", Color::kPurple},
    ColorWord{"teal", Color::kTurquoise}, ColorWord{"cyan", Color::kTurquoise},
    ColorWord{"magenta", Color::kPink},   ColorWord{"cream", Color::kBeige}};

struct ShadeWord {
  std::string_view word;
  Shade shade;
};
constexpr std::array kShadeWords{ShadeWord{"dark", Shade::kDark}, ShadeWord{"light", Shade::kLight},
                                 ShadeWord{"deep", Shade::kDark}, ShadeWord{"pale", Shade::kLight}};

struct FocalColor {
  Color color;
  std::uint8_t r, g, b;
};
constexpr std::array kFocal{
    FocalColor{Color::kBlack, 12, 12, 12},     FocalColor{Color::kBlack, 40, 40, 42},
    FocalColor{Color::kGrey, 95, 95, 97},      FocalColor{Color::kGrey, 140, 140, 142},
    FocalColor{Color::kGrey, 180, 180, 182},   FocalColor{Color::kWhite, 225, 225, 225},
    FocalColor{Color::kWhite, 250, 250, 250},  FocalColor{Color::kRed, 205, 30, 40},
    FocalColor{Color::kRed, 125, 20, 28},      FocalColor{Color::kOrange, 240, 125, 25},
    FocalColor{Color::kYellow, 245, 215, 45},  FocalColor{Color::kYellow, 200, 170, 30},
    FocalColor{Color::kGreen, 45, 150, 60},    FocalColor{Color::kGreen, 25, 75, 35},
    FocalColor{Color::kGreen, 140, 200, 110},  FocalColor{Color::kTurquoise, 40, 175, 170},
    FocalColor{Color::kBlue, 35, 85, 195},     FocalColor{Color::kBlue, 25, 40, 100},
    FocalColor{Color::kBlue, 120, 180, 235},   FocalColor{Color::kPurple, 115, 45, 150},
    FocalColor{Color::kPurple, 165, 120, 215}, FocalColor{Color::kPink, 245, 165, 190},
    FocalColor{Color::kPink, 230, 70, 150},    FocalColor{Color::kBrown, 110, 65, 35},
    FocalColor{Color::kBrown, 155, 105, 65},   FocalColor{Color::kBrown, 70, 42, 28},
    FocalColor{Color::kBeige, 222, 203, 168},  FocalColor{Color::kBeige, 190, 165, 130}};

constexpr float kLightnessWeight = 0.6f;
constexpr float kNameDeviation = 0.05f;  // in OKLab: about twice what is seen at a glance
constexpr float kSeenLightness = 0.5f * kNameDeviation / kLightnessWeight;  // at a glance
constexpr int kMostSamples = 400;                                           // of one object
constexpr float kGreyNorm = 6.f;
constexpr float kMostTint = 1.6f;  // of the light, between channels
constexpr float kBright = 0.75f, kLeastExposure = 0.8f, kMostExposure = 3.f;
constexpr std::size_t kCropsPerTask = 4;

float linear(std::uint8_t value) {
  const float v = static_cast<float>(value) / 255.f;
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

Eigen::Vector3f linear(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  return {linear(r), linear(g), linear(b)};
}

const std::vector<Eigen::Vector3f>& focal_oklab() {
  static const std::vector<Eigen::Vector3f> points = [] {
    std::vector<Eigen::Vector3f> all;
    for (const FocalColor& focal : kFocal) all.push_back(oklab(linear(focal.r, focal.g, focal.b)));
    return all;
  }();
  return points;
}

/// The lightness below which a colour is dark, and above which it is light: between the darkest and
/// the lightest of its focal colours, with a third in the middle that is neither.
std::pair<float, float> plain_lightness(Color color) {
  float darkest = 1.f, lightest = 0.f;
  for (std::size_t k = 0; k < kFocal.size(); ++k) {
    if (kFocal[k].color != color) continue;
    darkest = std::min(darkest, focal_oklab()[k].x());
    lightest = std::max(lightest, focal_oklab()[k].x());
  }
  const float middle = (darkest + lightest) / 2.f;
  const float half = std::max((lightest - darkest) / 6.f, kSeenLightness);
  return {middle - half, middle + half};
}

/// Empty where the picture cannot be read: it costs one object its colours, not all of them.
ObjectCrop readable(const StoredCrop& stored) {
  try {
    return restore_crop(stored);
  } catch (const Error&) {
    return {};
  }
}

std::vector<Eigen::Vector3f> samples_of(const StoredCrop& stored) {
  std::vector<Eigen::Vector3f> samples;
  if (stored.empty()) return samples;
  const ObjectCrop crop = readable(stored);
  std::vector<std::size_t> on_object;
  for (std::size_t i = 0; i < crop.mask.size(); ++i)
    if (crop.mask[i] != 0) on_object.push_back(i);
  const std::size_t count = std::min<std::size_t>(on_object.size(), kMostSamples);
  for (std::size_t k = 0; k < count; ++k) {
    const Rgb8 pixel = crop.image[on_object[k * on_object.size() / count]];
    samples.push_back(linear(pixel.r, pixel.g, pixel.b));
  }
  return samples;
}

/// What channels are multiplied by to take the light out.
Eigen::Array3f light_gain(std::span<const std::vector<Eigen::Vector3f>> objects) {
  Eigen::Array3f powers = Eigen::Array3f::Zero();
  float count = 0.f;
  for (const auto& samples : objects) {
    if (samples.empty()) continue;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const Eigen::Vector3f& sample : samples) sum += sample;
    powers += (sum.array() / static_cast<float>(samples.size())).pow(kGreyNorm);
    count += 1.f;
  }
  if (count == 0.f) return Eigen::Array3f::Ones();
  const Eigen::Array3f light = (powers / count).pow(1.f / kGreyNorm).max(1e-4f);
  const Eigen::Array3f tint = (light.mean() / light).max(1.f / kMostTint).min(kMostTint);
  return tint * std::clamp(kBright / light.maxCoeff(), kLeastExposure, kMostExposure);
}

}  // namespace

const char* color_name(Color color) {
  return kColorWords[static_cast<std::size_t>(color)].word.data();  // the first are in their order
}

std::optional<Color> color_of_word(std::string_view word) {
  for (const ColorWord& known : kColorWords)
    if (known.word == word) return known.color;
  return std::nullopt;
}

const char* shade_name(Shade shade) {
  return kShadeWords[static_cast<std::size_t>(shade)].word.data();  // the first are in their order
}

std::optional<Shade> shade_of_word(std::string_view word) {
  for (const ShadeWord& known : kShadeWords)
    if (known.word == word) return known.shade;
  return std::nullopt;
}

Eigen::Vector3f oklab(const Eigen::Vector3f& linear_rgb) {
  Eigen::Matrix3f cones, lab;
  cones << 0.4122214708f, 0.5363325363f, 0.0514459929f, 0.2119034982f, 0.6806995451f, 0.1073969566f,
      0.0883024619f, 0.2817188376f, 0.6299787005f;
  lab << 0.2104542553f, 0.7936177850f, -0.0040720468f, 1.9779984951f, -2.4285922050f, 0.4505937099f,
      0.0259040371f, 0.7827717662f, -0.8086757660f;
  const Eigen::Vector3f responses = (cones * linear_rgb).cwiseMax(0.f);
  return lab * responses.unaryExpr([](float value) { return std::cbrt(value); });
}

SurfaceColors name_colors(std::span<const Eigen::Vector3f> linear_rgb) {
  SurfaceColors surface;
  for (const Eigen::Vector3f& pixel : linear_rgb) {
    const Eigen::Vector3f seen = oklab(pixel);
    std::array<float, kFocal.size()> distances{};
    for (std::size_t k = 0; k < kFocal.size(); ++k) {
      const Eigen::Vector3f apart = seen - focal_oklab()[k];
      distances[k] = kLightnessWeight * kLightnessWeight * apart.x() * apart.x() +
                     apart.tail<2>().squaredNorm();
    }
    const float nearest = *std::min_element(distances.begin(), distances.end());
    float sum = 0.f;
    for (float& distance : distances)
      sum += distance = std::exp((nearest - distance) / (2.f * kNameDeviation * kNameDeviation));
    for (std::size_t k = 0; k < kFocal.size(); ++k) {
      const auto color = static_cast<std::size_t>(kFocal[k].color);
      const float share = distances[k] / sum / static_cast<float>(linear_rgb.size());
      surface.shares[color] += share;
      surface.lightness[color] += share * seen.x();
    }
  }
  for (std::size_t color = 0; color < kColorCount; ++color)
    if (surface.shares[color] > 0.f) surface.lightness[color] /= surface.shares[color];
  return surface;
}

float shade_rating(Color color, float lightness, Shade shade) {
  const auto [dark, light] = plain_lightness(color);
  const float beyond = shade == Shade::kLight ? lightness - light : dark - lightness;
  return 1.f / (1.f + std::exp(-beyond / kSeenLightness));
}

const std::vector<SurfaceColors>& ObjectColors::surfaces() const {
  std::call_once(once_, [&] {
    const std::vector<StoredCrop> crops = crops_();
    std::vector<std::vector<Eigen::Vector3f>> samples(crops.size());
    parallel_for(crops.size(), kCropsPerTask,
                 [&](std::size_t i) { samples[i] = samples_of(crops[i]); });
    const Eigen::Array3f gain = light_gain(samples);
    surfaces_.resize(crops.size());
    parallel_for(crops.size(), kCropsPerTask, [&](std::size_t i) {
      for (Eigen::Vector3f& sample : samples[i]) sample = (sample.array() * gain).min(1.f).matrix();
      surfaces_[i] = name_colors(samples[i]);
    });
  });
  return surfaces_;
}

}  // namespace ovimap
