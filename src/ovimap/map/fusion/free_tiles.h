// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/geometry/view_bounds.h"
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

inline Image<float> most_of_squares(const Image<float>& values, int side) {
  return joined_squares(values, side, 0.f, [](float a, float b) { return a < b ? b : a; });
}

/// Free depth by tile of the image, one value for each.
class FreeTiles {
 public:
  static constexpr float kNear_m =
      0.05f;  ///< what reaches nearer is around the camera or beside it

  FreeTiles(const PinholeCamera& camera, int tile_px, Image<float> free_m)
      : camera_(camera), tile_px_(tile_px), free_m_(std::move(free_m)) {
    for (const float free : free_m_) most_m_ = std::max(most_m_, free);
  }
  FreeTiles coarser(int side) const {
    return {camera_, tile_px_ * side, most_of_squares(free_m_, side)};
  }

  /// The furthest of the tiles that a sphere may show in (camera frame, metres); 0 where all of it
  /// lies behind that, or beyond the view.
  float furthest(const Eigen::Vector3f& center, float radius) const {
    const float near_m = center.z() - radius;
    if (center.z() + radius <= 0.f || near_m >= most_m_) return 0.f;
    if (near_m < kNear_m) return beyond_view(camera_, center, radius) ? 0.f : most_m_;
    float furthest_m = 0.f;
    for_tiles(pixels_around(camera_, center, radius), [&](float free_m) {
      furthest_m = std::max(furthest_m, free_m);
      return true;
    });
    return near_m < furthest_m ? furthest_m : 0.f;
  }

  /// Of the tiles that hold some of these pixels, until `visit` says no; returns whether it did
  /// not.
  template <class Visit>
  bool for_tiles(const Eigen::AlignedBox2f& pixels, const Visit& visit) const {
    const int left = std::max(tile(pixels.min().x()), 0), top = std::max(tile(pixels.min().y()), 0),
              right = std::min(tile(pixels.max().x()), free_m_.width() - 1),
              bottom = std::min(tile(pixels.max().y()), free_m_.height() - 1);
    for (int y = top; y <= bottom; ++y)
      for (int x = left; x <= right; ++x)
        if (!visit(free_m_.at(x, y))) return false;
    return true;
  }
  float most_m() const { return most_m_; }

 private:
  int tile(float pixel) const {
    constexpr float kFar_px = 1e6f;
    const auto side = static_cast<float>(tile_px_);
    const float from_before = std::clamp(pixel, -side, kFar_px) + 0.5f + side;  // positive
    return static_cast<int>(from_before) / tile_px_ - 1;
  }

  const PinholeCamera& camera_;
  int tile_px_;
  Image<float> free_m_;
  float most_m_ = 0;
};

/// Least free depth by tile of the image: tells of spheres whether all of one, or any, lies in free
/// space.
class LeastTiles {
 public:
  static constexpr int kTile_px = 8;

  LeastTiles(const PinholeCamera& camera, const Image<float>& free_m)
      : camera_(camera),
        least_(camera, kTile_px,
               joined_squares(free_m, kTile_px, std::numeric_limits<float>::max(),
                              [](float a, float b) { return b < a ? b : a; })) {}

  /// Whether all of a sphere (camera frame, metres) shows in the image, and every pixel of the
  /// tiles it shows in runs free to behind it.
  bool all_free(const Eigen::Vector3f& center, float radius) const {
    const float far_m = center.z() + radius;
    if (center.z() - radius < FreeTiles::kNear_m || far_m >= least_.most_m()) return false;
    const Eigen::AlignedBox2f covered = pixels_around(camera_, center, radius);
    if (covered.min().minCoeff() < 0.f ||
        covered.max().x() > static_cast<float>(camera_.width - 1) ||
        covered.max().y() > static_cast<float>(camera_.height - 1))
      return false;
    return least_.for_tiles(covered, [far_m](float free_m) { return free_m > far_m; });
  }

  /// True only where nothing that lies in the sphere, of any size, is `all_free`.
  bool none_free(const Eigen::Vector3f& center, float radius) const {
    const float near_m = center.z() - radius;
    if (near_m >= least_.most_m()) return true;
    if (near_m < FreeTiles::kNear_m) return false;
    return least_.for_tiles(pixels_around(camera_, center, radius),
                            [near_m](float free_m) { return free_m <= near_m; });
  }

  /// False only where no part of the sphere may be in view before the furthest free depth.
  bool any_free(const Eigen::Vector3f& center, float radius) const {
    if (center.z() + radius < FreeTiles::kNear_m || center.z() - radius >= least_.most_m())
      return false;
    return !beyond_view(camera_, center, radius);
  }

  /// A box of the world around the part of the view that may be free.
  Eigen::AlignedBox3d reach(const Pose& world_from_camera) const {
    return box_of_view(camera_, world_from_camera, least_.most_m());
  }

 private:
  const PinholeCamera& camera_;
  FreeTiles least_;
};

}  // namespace ovimap
