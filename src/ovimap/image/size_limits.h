// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace ovimap {

/// The largest image that any reader makes: sides and pixels. A header that claims more is that of
/// a broken file, not of a camera.
inline constexpr std::uint64_t kLargestSide_px = 32767;
inline constexpr std::uint64_t kLargestArea_px = std::uint64_t{1} << 27;

inline constexpr bool plausible_size(std::uint64_t width, std::uint64_t height) {
  return width > 0 && height > 0 && width <= kLargestSide_px && height <= kLargestSide_px &&
         width * height <= kLargestArea_px;
}

/// Whether so many compressed bytes can hold `size` bytes at all: deflate repeats 258 bytes with no
/// fewer than 2 bits. Asked before memory is taken for them.
inline constexpr bool deflate_can_hold(std::uint64_t compressed, std::uint64_t size) {
  constexpr std::uint64_t kMostTimes = 258 * 8 / 2;
  return size / kMostTimes <= compressed;
}

}  // namespace ovimap
