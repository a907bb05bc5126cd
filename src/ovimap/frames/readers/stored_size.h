// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace ovimap {

/// Whether `bytes` may be an image of `width` x `height` in one of the layouts of a single file: at
/// most twice its pixels as numbers, which no compression reaches, and some more.
inline bool plausible_image_size(std::uint64_t bytes, int width, int height) {
  constexpr std::uint64_t kMostBytesAPixel = 6, kMostBytesBeside = std::uint64_t{1} << 20;
  const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  return bytes <= kMostBytesAPixel * pixels + kMostBytesBeside;
}

}  // namespace ovimap
