// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace ovimap {

/// Red, green and blue of a voxel in one word: 11, 11 and 10 bits, the lowest first, in steps of
/// 1/8, 1/8 and 1/4 of one of 255 levels. 0: none yet.
using PackedColor = std::uint32_t;

struct ColorField {
  int shift, bits, fraction_bits;

  constexpr std::uint32_t mask() const { return (1u << bits) - 1; }
  constexpr float steps() const { return static_cast<float>(1 << fraction_bits); }
};
inline constexpr std::array<ColorField, 3> kColorFields = {{{0, 11, 3}, {11, 11, 3}, {22, 10, 2}}};

/// Red, green, blue, in 1/256 of a level.
using FixedColor = std::array<std::uint16_t, 3>;

inline FixedColor unpack_color(PackedColor packed) {
  FixedColor color;
  for (std::size_t c = 0; c < color.size(); ++c) {
    const ColorField& field = kColorFields[c];
    color[c] = static_cast<std::uint16_t>((packed >> field.shift & field.mask())
                                          << (8 - field.fraction_bits));
  }
  return color;
}

/// Rounds to the nearest step.
inline PackedColor pack_color(const FixedColor& color) {
  PackedColor packed = 0;
  for (std::size_t c = 0; c < color.size(); ++c) {
    const ColorField& field = kColorFields[c];
    const int dropped = 8 - field.fraction_bits;
    packed |= std::min((color[c] + (1u << (dropped - 1))) >> dropped, field.mask()) << field.shift;
  }
  return packed;
}

/// Whole levels.
inline std::array<std::uint8_t, 3> color_levels(PackedColor packed) {
  const FixedColor color = unpack_color(packed);
  return {static_cast<std::uint8_t>(color[0] >> 8), static_cast<std::uint8_t>(color[1] >> 8),
          static_cast<std::uint8_t>(color[2] >> 8)};
}

}  // namespace ovimap
