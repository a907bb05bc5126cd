// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/segment/depth_segmentation.h"

namespace ovimap {

/// 1 at pixels on a concave fold of the surface, 0 elsewhere. Only ridges of the fold angle are
/// kept, so lines are about one pixel thin.
///
/// The surface folds concavely between two points when it bends towards the camera:
/// (p2 - p1) . (n1 - n2) > 0 (Stein et al. 2014, LCCP). Normals are compared one window radius to
/// either side of the pixel, where their windows do not overlap the fold.
Image<std::uint8_t> find_concave_edges(const DepthSurface& surface, const PinholeCamera& camera,
                                       const SegmentDepthConfig& config);

}  // namespace ovimap
