// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/segment/depth_surface.h"
#include "ovimap/segment/inverse_depth.h"

namespace ovimap {

/// Fills `breaks` and the four arms of `surface`, whose images have the depth's size and whose
/// radius is set.
void find_breaks(const InverseDepth& inverse, const DepthSurfaceConfig& config,
                 DepthSurface& surface);

}  // namespace ovimap
