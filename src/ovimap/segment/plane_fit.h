// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/segment/depth_surface.h"
#include "ovimap/segment/inverse_depth.h"

namespace ovimap {

/// Inverse depth in integers, 1/m per unit: coarse enough that the sums of a window with this
/// radius fit in 32 bits. 2^-19 at 6 pixels, far below any sensor's noise; 2^-7 at 100, where
/// rounding averages out over the window's 40,000 pixels.
float inverse_depth_unit(int radius_px);

/// Fills smooth depth, normals and slopes of `surface`, whose breaks and arms are set: least
/// squares q = a u + b v + c over the window of each pixel, rows as far up and down as its column
/// is unbroken, each row as far left and right as that row is.
///
/// Window sums are differences of running sums down the columns, so the cost does not depend on the
/// radius. The sums are integers modulo 2^32: exact, whatever the running sums have grown to.
void fit_planes(const InverseDepth& inverse, const PinholeCamera& camera, DepthSurface& surface);

}  // namespace ovimap
