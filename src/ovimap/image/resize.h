// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/image/image.h"

namespace ovimap {

/// Bilinear with antialiasing when shrinking (a triangle filter as wide as the scale), edges
/// clamped.
RgbImage resize_bilinear(const RgbImage& image, int width, int height);

/// Nearest neighbour, for ids and masks: never invents a value.
IdImage resize_nearest(const IdImage& image, int width, int height);

}  // namespace ovimap
