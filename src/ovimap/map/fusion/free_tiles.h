// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/geometry/sphere_in_view.h"
#include "ovimap/image/image.h"

namespace ovimap {

/// What `join` makes of each square of pixels, beginning with `first`.
template <class Join>
Image<float> joined_squares(const Image<float>& values, int side, float first, const Join& join) {
  const int width = values.width(), height = values.height();
  Image<float> squares((width + side - 1) / side, (height + side - 1) / side, first);
  std::vector<float> columns(static_cast<std::size_t>(width));
  for (int top = 0; top < height; top += side) {
    std::fill(columns.begin(), columns.end(), first);
    for (int y = top; y < std::min(top + side, height); ++y) {
      const float* const row = values.row(y);
      for (std::size_t x = 0; x < columns.size(); ++x) columns[x] = join(columns[x], row[x]);
    }
    float* into = squares.row(top / side);
    for (int x = 0, in_square = 0; x < width; ++x) {
      *into = join(*into, columns[static_cast<std::size_t>(x)]);
      if (++in_square == side) ++into, in_square = 0;
    }
  }
  return squares;
}

/// Least and furthest free depth by tile of the image: tells of spheres whether all of one, or any,
/// lies in free space.
class LeastTiles {
 public:
  static constexpr int kTile_px = 8;

  LeastTiles(const PinholeCamera& camera, const Image<float>& free_m)
      : camera_(camera),
        least_m_(joined_squares(free_m, kTile_px, std::numeric_limits<float>::max(),
                                [](float a, float b) { return b < a ? b : a; })) {
    for (const float least : least_m_) most_m_ = std::max(most_m_, least);
  }

  /// Whether all of a sphere (camera frame, metres) shows in the image, and every pixel of the
  /// tiles it shows in runs free to behind it.
  bool all_free(const Eigen::Vector3f& center, float radius) const {
    const float near_m = center.z() - radius, far_m = center.z() + radius;
    if (near_m < kNear_m || far_m >= most_m_) return false;
    const Eigen::AlignedBox2f covered = pixels_around(camera_, center, radius);
    const float left = covered.min().x(), right = covered.max().x(), top = covered.min().y(),
                bottom = covered.max().y();
    if (left < 0.f || top < 0.f || right > static_cast<float>(camera_.width - 1) ||
        bottom > static_cast<float>(camera_.height - 1))
      return false;
    for (int y = tile(top); y <= tile(bottom); ++y)
      for (int x = tile(left); x <= tile(right); ++x)
        if (least_m_.at(x, y) <= far_m) return false;
    return true;
  }

  /// True only where nothing that lies in the sphere, of any size, is `all_free`.
  bool none_free(const Eigen::Vector3f& center, float radius) const {
    const float near_m = center.z() - radius;
    if (near_m >= most_m_) return true;
    if (near_m < kNear_m) return false;
    const Eigen::AlignedBox2f covered = pixels_around(camera_, center, radius);
    if (covered.max().minCoeff() < 0.f) return true;
    const int left = tile(std::max(covered.min().x(), 0.f)),
              top = tile(std::max(covered.min().y(), 0.f)),
              right = std::min(tile(covered.max().x()), least_m_.width() - 1),
              bottom = std::min(tile(covered.max().y()), least_m_.height() - 1);
    for (int y = top; y <= bottom; ++y)
      for (int x = left; x <= right; ++x)
        if (least_m_.at(x, y) > near_m) return false;
    return true;
  }

  /// False only where no part of the sphere may be in view before the furthest free depth.
  bool any_free(const Eigen::Vector3f& center, float radius) const {
    if (center.z() + radius < kNear_m || center.z() - radius >= most_m_) return false;
    return !beyond_view(camera_, center, radius);
  }

  /// A box of the world around the part of the view that may be free.
  Eigen::AlignedBox3d reach(const Pose& world_from_camera) const {
    Eigen::AlignedBox3d box(world_from_camera.translation());
    for (const float u : {0.f, static_cast<float>(camera_.width - 1)})
      for (const float v : {0.f, static_cast<float>(camera_.height - 1)})
        box.extend(world_from_camera * camera_.unproject(u, v, most_m_).cast<double>());
    return box;
  }

 private:
  static constexpr float kNear_m = 0.05f;
  static int tile(float pixel) { return static_cast<int>(pixel + 0.5f) / kTile_px; }

  const PinholeCamera& camera_;
  Image<float> least_m_;
  float most_m_ = 0;
};

}  // namespace ovimap
