// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/image/image.h"

namespace ovimap {

/// How wide the sharp edges of a picture are along its rows or its columns.
struct EdgeWidth {
  float px = 1.f;  ///< 1: from one pixel to the next
  int edges = 0;   ///< that it was measured on; 0: px is not known
};

/// How smeared a picture is. Motion smears along its way alone, a lens out of focus both ways.
struct Blur {
  EdgeWidth across;  ///< along rows: of upright edges
  EdgeWidth down;    ///< along columns
};

/// Measures blur without a sharp picture to compare with, by the width of edges (after Marziliano,
/// Dufaux, Winkler, Ebrahimi, "A no-reference perceptual blur metric", 2002). What the picture
/// shows hardly matters: whatever is in it, no edge is narrower than the blur, so the narrow ones
/// of its edges tell. An edge is a rise or a fall of brightness well above a camera's noise.
/// \param line_step looks at every so many rows and columns
Blur measure_blur(const RgbImage& image, int line_step = 1);

}  // namespace ovimap
