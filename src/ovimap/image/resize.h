// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/image/image.h"

namespace ovimap {

enum class ResizeFilter {
  kBilinear,  ///< triangle
  kBicubic    ///< Keys' cubic with a = -1/2
};

/// A part of an image.
struct ImageWindow {
  int left_px = 0, top_px = 0, width_px = 0, height_px = 0;
};

/// Antialiased: when shrinking, the filter is as wide as the scale. Edges are clamped. Across
/// first, then down, each rounded to bytes with weights of 22 bits, as Pillow up to version 12
/// does: networks were trained on its pixels, and this gives the same ones.
RgbImage resize_filtered(const RgbImage& image, int width, int height, ResizeFilter filter);

/// The part `window` of the image resized to width x height, without computing the rest. Throws
/// Error when it is not inside.
RgbImage resize_window(const RgbImage& image, int width, int height, const ImageWindow& window,
                       ResizeFilter filter);

inline RgbImage resize_bilinear(const RgbImage& image, int width, int height) {
  return resize_filtered(image, width, height, ResizeFilter::kBilinear);
}

/// Nearest neighbour, for ids and masks: never invents a value.
IdImage resize_nearest(const IdImage& image, int width, int height);

}  // namespace ovimap
