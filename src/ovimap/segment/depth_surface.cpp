// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/depth_surface.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/config.h"
#include "ovimap/segment/plane_fit.h"
#include "ovimap/segment/surface_breaks.h"

namespace ovimap {

namespace {

DepthSurface allocate(int width, int height, int radius_px) {
  const auto bytes = [&] { return Image<std::uint8_t>::unset(width, height); };
  const auto numbers = [&] { return Image<float>::unset(width, height); };
  return {radius_px, bytes(),     bytes(),   bytes(),
          bytes(),   bytes(),     numbers(), NormalImage::unset(width, height),
          numbers(), FrameNoise{}};
}

}  // namespace

void list_fields(DepthNoiseConfig& config, ConfigFields& fields) {
  fields.add("base_m", config.base_m, 0.f, 1.f,
             "depth noise at offset_m, standard deviation, metres");
  fields.add("quadratic_per_m", config.quadratic_per_m, 0.f, 1.f,
             "growth of the noise with squared range, 1/m");
  fields.add("offset_m", config.offset_m, 0.f, 10.f, "range at which the noise is least, metres");
}

void list_fields(DepthSurfaceConfig& config, ConfigFields& fields) {
  fields.group("noise", [&](ConfigFields& f) { list_fields(config.noise, f); });
  fields.add("discontinuity_sigmas", config.discontinuity_sigmas, 0.f, 100.f,
             "depth step off the slope that makes an edge, in noise sigmas; 0: no such edges");
  fields.add("discontinuity_ratio", config.discontinuity_ratio, 0.f, 1.f,
             "depth step between neighbours that is always an edge, as a share of depth");
  fields.add("normal_radius_rad", config.normal_radius_rad, 0.001f, 0.1f,
             "half window of the plane fit, radians of view");
}

DepthSurface fit_depth_surface(const DepthImage& depth, const PinholeCamera& camera,
                               const DepthSurfaceConfig& config) {
  const int radius =
      std::clamp(static_cast<int>(std::lround(config.normal_radius_rad * camera.fx)), 2, 100);
  DepthSurface surface = allocate(depth.width(), depth.height(), radius);
  const InverseDepth inverse(depth);
  find_breaks(inverse, config, surface);
  fit_planes(inverse, camera, surface);
  surface.noise = read_noise(depth, surface, camera, config.noise);
  return surface;
}

float normal_sigma_rad(float depth_m, int radius_px, const PinholeCamera& camera,
                       const DepthNoiseConfig& noise) {
  const float side = 2.f * static_cast<float>(radius_px) + 1.f;
  const float spread_px = std::sqrt((side * side - 1.f) / 12.f);  // of positions along one axis
  const float pixel_m = depth_m / camera.fx;
  return noise.sigma_m(depth_m) / (side * spread_px * pixel_m);
}

}  // namespace ovimap
