// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/segment/depth_surface.h"

namespace ovimap {

struct DepthEstimateConfig {
  bool enabled = true;        ///< off: depth is fused as it was measured, with weights of 1/z^2
  float correlated_px = 9.f;  ///< so many neighbouring pixels err alike and count as one sample:
                              ///< matching windows of stereo and structured light are some pixels
                              ///< wide
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
/// How noisy the sensor is the frame itself tells: the median residual of each half octave of
/// range, most of what is seen being smooth. `noise` gives the growth within a range, and all of it
/// in frames too small to tell.
DepthEstimate estimate_depth(const DepthImage& depth, const DepthSurface& surface,
                             const DepthNoiseConfig& noise, const DepthEstimateConfig& config);

}  // namespace ovimap
