// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/segment/depth_segmentation.h"

namespace ovimap {

/// Gives pixels between regions (label 0, with depth) to the region whose nearest interior pixel is
/// nearest in 3D: ring after ring of 8-neighbours, up to `regrow_px` rings and `regrow_m` metres.
/// `labels` has the surface's size.
void grow_regions(const DepthSurface& surface, const PinholeCamera& camera,
                  const SegmentDepthConfig& config, Image<std::uint32_t>& labels);

}  // namespace ovimap
