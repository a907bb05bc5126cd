// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/images/track_pyramid.h"

#include <algorithm>

#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

constexpr std::size_t kRowsPerTask = 8;

float luma(const Rgb8& color) {
  return 0.299f * static_cast<float>(color.r) + 0.587f * static_cast<float>(color.g) +
         0.114f * static_cast<float>(color.b);
}

/// The camera of an image whose pixels are means of squares of `factor` pixels; a rest at the right
/// and at the bottom is left out.
PinholeCamera shrunk(const PinholeCamera& camera, int factor) {
  const auto by = static_cast<float>(factor);
  return {camera.width / factor, camera.height / factor,         camera.fx / by,
          camera.fy / by,        (camera.cx + 0.5f) / by - 0.5f, (camera.cy + 0.5f) / by - 0.5f};
}

/// Mean over a square of those inverse depths that are near the greatest, the nearest surface; 0
/// where none is valid. `inverse(x, y)` gives them.
template <class Inverse>
float nearest_surface(int x0, int y0, int side, const Inverse& inverse) {
  float nearest = 0;
  for (int y = y0; y < y0 + side; ++y)
    for (int x = x0; x < x0 + side; ++x) nearest = std::max(nearest, inverse(x, y));
  if (nearest == 0) return 0;
  float sum = 0, count = 0;
  for (int y = y0; y < y0 + side; ++y)
    for (int x = x0; x < x0 + side; ++x) {
      const float value = inverse(x, y);
      const float counts = value > (1 - kOneSurface) * nearest ? 1.f : 0.f;
      sum += counts * value, count += counts;
    }
  return sum / count;
}

/// Mean intensity of a square of the colour image; -1 where it is black, which stands for unknown.
float mean_luma(const RgbImage& color, int x0, int y0, int side) {
  float sum = 0;
  for (int y = y0; y < y0 + side; ++y)
    for (int x = x0; x < x0 + side; ++x) sum += luma(color.row(y)[x]);
  return sum > 0 ? sum / static_cast<float>(side * side) : -1;
}

/// The intensity that another camera saw at a point of the depth camera.
float seen_by_color(const Frame& frame, const Eigen::Isometry3f& color_from_depth,
                    const Eigen::Vector3f& point) {
  const Eigen::Vector3f in_color = color_from_depth * point;
  if (in_color.z() <= 0) return -1;
  const Eigen::Vector2f pixel = frame.color_camera.project(in_color);
  if (!(pixel.x() >= 0 && pixel.y() >= 0 &&
        pixel.x() < static_cast<float>(frame.color.width() - 1) &&
        pixel.y() < static_cast<float>(frame.color.height() - 1)))
    return -1;
  const int x = static_cast<int>(pixel.x()), y = static_cast<int>(pixel.y());
  return mean_luma(frame.color, x, y, 2);
}

TrackLevel finest_level(const Frame& frame) {
  const int factor = std::max(1, (frame.depth.width() + kFinestWidth_px / 2) / kFinestWidth_px);
  TrackLevel level;
  level.camera = shrunk(frame.depth_camera, factor);
  level.intensity = Image<float>(level.camera.width, level.camera.height, -1.f);
  level.inverse_depth = Image<float>(level.camera.width, level.camera.height);
  const bool registered = frame.registered();
  const Eigen::Isometry3f color_from_depth = frame.color_from_depth.cast<float>();
  const auto inverse = [&](int x, int y) {
    const float depth = frame.depth.row(y)[x];
    return depth > 0 ? 1 / depth : 0.f;
  };
  parallel_for(static_cast<std::size_t>(level.camera.height), kRowsPerTask, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < level.camera.width; ++x) {
      const float near = nearest_surface(x * factor, y * factor, factor, inverse);
      level.inverse_depth.row(y)[x] = near;
      if (registered)
        level.intensity.row(y)[x] = mean_luma(frame.color, x * factor, y * factor, factor);
      else if (near > 0)
        level.intensity.row(y)[x] = seen_by_color(
            frame, color_from_depth,
            level.camera.unproject(static_cast<float>(x), static_cast<float>(y), 1 / near));
    }
  });
  return level;
}

TrackLevel halved(const TrackLevel& fine) {
  TrackLevel level;
  level.camera = shrunk(fine.camera, 2);
  level.intensity = Image<float>(level.camera.width, level.camera.height, -1.f);
  level.inverse_depth = Image<float>(level.camera.width, level.camera.height);
  const auto inverse = [&](int x, int y) { return fine.inverse_depth.row(y)[x]; };
  parallel_for(static_cast<std::size_t>(level.camera.height), kRowsPerTask, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < level.camera.width; ++x) {
      level.inverse_depth.row(y)[x] = nearest_surface(2 * x, 2 * y, 2, inverse);
      const float* upper = fine.intensity.row(2 * y) + 2 * x;
      const float* lower = fine.intensity.row(2 * y + 1) + 2 * x;
      if (std::min({upper[0], upper[1], lower[0], lower[1]}) >= 0)
        level.intensity.row(y)[x] = (upper[0] + upper[1] + lower[0] + lower[1]) / 4;
    }
  });
  return level;
}

}  // namespace

void add_coarser_levels(TrackPyramid& pyramid) {
  while (pyramid.size() < kFewestLevels || pyramid.back().camera.width >= 2 * kCoarsestWidth_px)
    pyramid.push_back(halved(pyramid.back()));
}

TrackPyramid make_pyramid(const Frame& frame) {
  TrackPyramid pyramid{finest_level(frame)};
  add_coarser_levels(pyramid);
  return pyramid;
}

}  // namespace ovimap
