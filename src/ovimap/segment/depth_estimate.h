// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/segment/depth_surface.h"

namespace ovimap {

struct DepthEstimateConfig {
  bool enabled = true;  ///< off: depth is fused as it was measured, with weights of 1/z^2
};
void list_fields(DepthEstimateConfig& config, ConfigFields& fields);

/// What a frame says of the distance of every pixel. Images of the depth image's size.
struct DepthEstimate {
  DepthImage depth_m;    ///< 0 = invalid
  Image<float> sigma_m;  ///< standard deviation; 0 where depth is invalid; empty: unknown
};

/// Depth between what the sensor measured and what the planes around say, as much of each as the
/// residuals ask for: the local linear minimum mean square error filter (Lee, IEEE PAMI 2, 1980)
/// with the fitted planes as local means. Where residuals are what noise alone leaves, the plane is
/// believed; where they are larger, there is something that no plane describes.
///
/// How noisy the sensor is the frame itself tells (DepthSurface::noise), both a single pixel and
/// the plane through a window of them. `model`, with which the surface was fitted, gives the growth
/// within a range.
DepthEstimate estimate_depth(const DepthImage& depth, const DepthSurface& surface,
                             const DepthNoiseConfig& model, const DepthEstimateConfig& config);

}  // namespace ovimap
