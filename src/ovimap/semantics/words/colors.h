// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "ovimap/semantics/views/object_crop.h"

namespace ovimap {

/// The eleven basic colour terms of English (Berlin and Kay 1969), beige and turquoise.
enum class Color {
  kBlack,
  kGrey,
  kWhite,
  kRed,
  kOrange,
  kYellow,
  kGreen,
  kTurquoise,
  kBlue,
  kPurple,
  kPink,
  kBrown,
  kBeige
};
inline constexpr std::size_t kColorCount = 13;

const char* color_name(Color color);
/// In lower case; knows "gray", "violet" and the like.
std::optional<Color> color_of_word(std::string_view word);

/// "dark blue", "light green".
enum class Shade { kDark, kLight };

const char* shade_name(Shade shade);
/// In lower case; knows "deep" and "pale". "Bright" is none: it may be strong or light.
std::optional<Shade> shade_of_word(std::string_view word);

/// [Color] shares of an object's surface, summing to 1; all 0: not known.
using ColorShares = std::array<float, kColorCount>;
/// [Color] the mean lightness of what is of that colour, of OKLab; 0 where nothing is.
using ColorLightness = std::array<float, kColorCount>;

struct SurfaceColors {
  ColorShares shares{};
  ColorLightness lightness{};
};

/// OKLab (Ottosson 2020) of linear sRGB in [0, 1]: lightness, then green-red and blue-yellow.
Eigen::Vector3f oklab(const Eigen::Vector3f& linear_rgb);

/// The names of some pixels' colours: each pixel shares itself among focal colours by their
/// distance in OKLab, in which lightness, which shading changes, counts less.
SurfaceColors name_colors(std::span<const Eigen::Vector3f> linear_rgb);

/// How plainly a colour of that lightness is dark or light, in (0, 1); one half is the border. The
/// middle third between the darkest and the lightest focal colour of the name is neither.
float shade_rating(Color color, float lightness, Shade shade);

/// The colours of a map's objects, found when they are first asked for. Light is taken out by the
/// map itself: channels are scaled, within bounds, so that its bright objects are grey on average
/// (shades of grey, Finlayson and Trezzi 2004) and bright. Thread-safe.
class ObjectColors {
 public:
  /// `crops`: one of each object, where there is one; called once.
  explicit ObjectColors(std::function<std::vector<StoredCrop>()> crops)
      : crops_(std::move(crops)) {}

  const std::vector<SurfaceColors>& surfaces() const;

 private:
  std::function<std::vector<StoredCrop>()> crops_;
  mutable std::once_flag once_;
  mutable std::vector<SurfaceColors> surfaces_;
};

}  // namespace ovimap
