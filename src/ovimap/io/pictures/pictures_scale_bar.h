// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/image/image.h"

namespace ovimap {

/// The bar's length: 1, 2 or 5 times a power of ten, the longest that is at most a fifth of the
/// width.
float scale_bar_length_m(int image_width_px, float px_per_m);

/// Draws a bar of that length with its label ("0.5 m") in the lower left corner.
void draw_scale_bar(RgbImage& image, float px_per_m);

}  // namespace ovimap
