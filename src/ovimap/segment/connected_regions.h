// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "ovimap/image/image.h"

namespace ovimap {

/// 4-connected components of the non-zero pixels of `mask`: ids 1, 2, ... in raster order of their
/// first pixels, 0 elsewhere. Works on runs of pixels, so its cost is that of reading the mask
/// once.
Image<std::uint32_t> connected_regions(const Image<std::uint8_t>& mask);

}  // namespace ovimap
