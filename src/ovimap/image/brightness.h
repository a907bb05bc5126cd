// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/image/image.h"

namespace ovimap {

/// 0 to 255: the weights of ITU-R BT.601 in 256ths, rounded down.
inline int brightness(Rgb8 pixel) {
  return (77 * pixel.r + 150 * pixel.g + 29 * pixel.b) >> 8;
}

}  // namespace ovimap
