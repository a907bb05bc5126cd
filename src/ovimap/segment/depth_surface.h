// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "ovimap/geometry/camera.h"
#include "ovimap/image/image.h"
#include "ovimap/segment/frame_noise.h"
#include "ovimap/segment/normal_image.h"

namespace ovimap {

class ConfigFields;

/// Standard deviation of depth along the optical axis, quadratic in range (Nguyen et al. 2012,
/// Kinect).
struct DepthNoiseConfig {
  float base_m = 0.0012f;
  float quadratic_per_m = 0.0019f;
  float offset_m = 0.4f;

  float sigma_m(float depth_m) const {
    const float range = depth_m - offset_m;
    return base_m + quadratic_per_m * range * range;
  }
};
void list_fields(DepthNoiseConfig& config, ConfigFields& fields);

struct DepthSurfaceConfig {
  DepthNoiseConfig noise;
  float discontinuity_sigmas =
      5.f;  ///< a depth step this many sigmas off the slope on both sides is an edge
  float discontinuity_ratio =
      0.03f;  ///< a step beyond this share of the depth is an edge whatever the slope
  float normal_radius_rad = 0.0105f;  ///< half window of the plane fit: 6 pixels at f = 585
};
void list_fields(DepthSurfaceConfig& config, ConfigFields& fields);

/// What plane fits say of every pixel of a depth image. All images have the depth image's size.
struct DepthSurface {
  enum Break : std::uint8_t { kRight = 1, kBelow = 2 };

  int radius_px = 0;            ///< half window of the plane fit
  Image<std::uint8_t> breaks;   ///< bits: the surface does not go on to the right / lower neighbour
  Image<std::uint8_t> left_px;  ///< unbroken pixels to the left, at most radius_px
  Image<std::uint8_t> right_px, up_px, down_px;  ///< likewise to the other sides
  Image<float> smooth_depth_m;  ///< depth of the fitted plane; 0 where depth is invalid
  NormalImage normals;          ///< unit, towards the camera, camera frame; 0 where no plane fits
  Image<float> plane_slope;     ///< metres off the plane per metre of depth along the pixel's ray:
                                ///< |normal . ray|, the ray with unit depth; 0 where no plane fits
  FrameNoise noise;             ///< in multiples of DepthSurfaceConfig::noise
};

/// Fits a plane to the unbroken neighbourhood of every pixel of `depth` (metres, 0 = invalid).
///
/// A plane is linear in inverse depth (1/z = a u + b v + c), so its least-squares fit needs only
/// window sums. The window is cut at depth discontinuities, first along rows, then along columns
/// (cross-based aggregation, Zhang et al. 2009): a constant cost per pixel, whatever the radius.
DepthSurface fit_depth_surface(const DepthImage& depth, const PinholeCamera& camera,
                               const DepthSurfaceConfig& config);

/// Standard deviation (radians) of a fitted normal facing the camera at `depth_m`, for a full
/// window of independent samples.
float normal_sigma_rad(float depth_m, int radius_px, const PinholeCamera& camera,
                       const DepthNoiseConfig& noise);

}  // namespace ovimap
