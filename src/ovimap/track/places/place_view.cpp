// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/places/place_view.h"

#include <algorithm>
#include <cmath>

namespace ovimap {

namespace {

constexpr float kNearest_m = 0.1f;  // nearer points would cover the view
constexpr int kWidest_px = 4;       // of a splat: points that are farther apart leave holes

/// Calls visit(pixel, inverse depth, intensity) for each pixel of a view that a point covers, which
/// is as large as its own pixel is from there.
template <class Visit>
void splat(const TrackLevel& image, const Eigen::Isometry3f& view_from_image,
           const PinholeCamera& camera, const Visit& visit) {
  for (int y = 0; y < image.inverse_depth.height(); ++y)
    for (int x = 0; x < image.inverse_depth.width(); ++x) {
      const float depth_m = 1 / image.inverse_depth.row(y)[x];
      if (!std::isfinite(depth_m)) continue;
      const Eigen::Vector3f point =
          view_from_image *
          image.camera.unproject(static_cast<float>(x), static_cast<float>(y), depth_m);
      if (point.z() < kNearest_m) continue;
      const Eigen::Vector2f at = camera.project(point);
      const float wide_px = depth_m / image.camera.fx * camera.fx / point.z();
      const int side = std::clamp(static_cast<int>(std::ceil(wide_px)), 1, kWidest_px);
      const Eigen::Vector2f corner = at.array() + 1 - static_cast<float>(side) / 2;
      if (!(corner.cwiseAbs().maxCoeff() < 1e6f)) continue;
      const int left = static_cast<int>(std::floor(corner.x())),
                top = static_cast<int>(std::floor(corner.y()));
      for (int v = std::max(0, top); v < std::min(camera.height, top + side); ++v)
        for (int u = std::max(0, left); u < std::min(camera.width, left + side); ++u)
          visit(static_cast<std::size_t>(v * camera.width + u), 1 / point.z(),
                image.intensity.row(y)[x]);
    }
}

/// Means of what shows the nearest surface.
struct Means {
  float inverse = 0, inverses = 0, intensity = 0, intensities = 0;
};

}  // namespace

TrackLevel place_view(std::span<const Keyframe> places, const PinholeCamera& camera,
                      const Pose& world_from_camera) {
  TrackLevel view;
  view.camera = camera;
  view.intensity = Image<float>(camera.width, camera.height, -1.f);
  view.inverse_depth = Image<float>(camera.width, camera.height, 0.f);
  const auto each = [&](const auto& visit) {
    for (const Keyframe& place : places)
      splat(place.image,
            (world_from_camera.inverse() * place.world_from_camera).template cast<float>(), camera,
            visit);
  };
  each([&](std::size_t pixel, float inverse, float) {
    view.inverse_depth[pixel] = std::max(view.inverse_depth[pixel], inverse);
  });
  std::vector<Means> means(view.inverse_depth.size());
  each([&](std::size_t pixel, float inverse, float intensity) {
    if (inverse < (1 - kOneSurface) * view.inverse_depth[pixel]) return;
    Means& mean = means[pixel];
    mean.inverse += inverse, mean.inverses += 1;
    if (intensity >= 0) mean.intensity += intensity, mean.intensities += 1;
  });
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (means[i].inverses > 0) view.inverse_depth[i] = means[i].inverse / means[i].inverses;
    if (means[i].intensities > 0) view.intensity[i] = means[i].intensity / means[i].intensities;
  }
  return view;
}

}  // namespace ovimap
