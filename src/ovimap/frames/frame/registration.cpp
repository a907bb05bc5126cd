// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/frame/registration.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

constexpr std::size_t kRegisteredRowsPerTask = 16;
constexpr std::int32_t kOutside = -1;

/// A colour pixel in one number, so that its column and row come back without a division.
std::int32_t packed(std::int32_t x, std::int32_t y) {
  return (y << 16) | x;
}
std::int32_t packed_x(std::int32_t pixel) {
  return pixel & 0xffff;
}
std::int32_t packed_y(std::int32_t pixel) {
  return pixel >> 16;
}

/// A depth image seen from the colour camera: for each depth pixel its colour pixel and distance.
struct Projected {
  Image<std::int32_t> pixel;  ///< packed, kOutside where there is none
  Image<float> z_m;           ///< along the colour camera's axis
};

/// The pixel whose square holds `coordinate`: -1 or `size` when it lies outside. Casting truncates
/// towards zero, hence the shift by one.
std::int32_t nearest_pixel(float coordinate, float size) {
  return static_cast<std::int32_t>(std::min(std::max(coordinate, -1.f), size) + 1.5f) - 1;
}

/// x_in_color = depth * (column_part + row_part) + t, with the rotated rays of columns and rows
/// known.
class DepthProjection {
 public:
  DepthProjection(const Frame& frame, const DepthImage& depth_m)
      : frame_(frame),
        depth_m_(depth_m),
        rotation_(frame.color_from_depth.linear().cast<float>()),
        translation_(frame.color_from_depth.translation().cast<float>()),
        columns_(3 * static_cast<std::size_t>(frame.depth.width())) {
    const PinholeCamera& camera = frame.depth_camera;
    const std::size_t width = static_cast<std::size_t>(frame.depth.width());
    for (std::size_t u = 0; u < width; ++u) {
      const Eigen::Vector3f part =
          rotation_.col(0) * ((static_cast<float>(u) - camera.cx) / camera.fx);
      for (std::size_t axis = 0; axis < 3; ++axis)
        columns_[axis * width + u] = part[static_cast<int>(axis)];
    }
  }

  void project_row(int v, std::int32_t* pixel, float* z_m) const {
    const PinholeCamera depth_camera = frame_.depth_camera, color = frame_.color_camera;
    const Eigen::Vector3f row =
        rotation_.col(1) * ((static_cast<float>(v) - depth_camera.cy) / depth_camera.fy) +
        rotation_.col(2);
    const float row_x = row.x(), row_y = row.y(), row_z = row.z();
    const float tx = translation_.x(), ty = translation_.y(), tz = translation_.z();
    const float width = static_cast<float>(color.width), height = static_cast<float>(color.height);
    const float* depth = depth_m_.row(v);
    const int count = depth_m_.width();
    const float* column_x = columns_.data();
    const float* column_y = column_x + count;
    const float* column_z = column_y + count;
    for (int u = 0; u < count; ++u) {
      const float z = depth[u] * (column_z[u] + row_z) + tz;
      const bool in_front = (depth[u] > 0) & (z > 0);
      const float x = color.fx * (depth[u] * (column_x[u] + row_x) + tx) / z + color.cx;
      const float y = color.fy * (depth[u] * (column_y[u] + row_y) + ty) / z + color.cy;
      const std::int32_t px = nearest_pixel(in_front ? x : -1.f, width);
      const std::int32_t py = nearest_pixel(in_front ? y : -1.f, height);
      const bool inside = (px >= 0) & (px < color.width) & (py >= 0) & (py < color.height);
      pixel[u] = inside ? packed(px, py) : kOutside;
      z_m[u] = z;
    }
  }

 private:
  const Frame& frame_;
  const DepthImage& depth_m_;
  Eigen::Matrix3f rotation_;
  Eigen::Vector3f translation_;
  std::vector<float> columns_;  ///< x of all columns, then y, then z
};

Projected project(const Frame& frame, const DepthImage& depth) {
  const int width = depth.width(), height = depth.height();
  Projected seen{Image<std::int32_t>::unset(width, height), Image<float>::unset(width, height)};
  const DepthProjection projection(frame, depth);
  parallel_for(static_cast<std::size_t>(height), kRegisteredRowsPerTask, [&](std::size_t row) {
    const int v = static_cast<int>(row);
    projection.project_row(v, seen.pixel.row(v), seen.z_m.row(v));
  });
  return seen;
}

/// Nearest distance by cell of the colour image. Where colour is finer than depth, single pixels
/// would leave holes between the points of one surface, so a cell spans at least one depth pixel.
class NearestSurface {
 public:
  NearestSurface(const Frame& frame, const Projected& seen) : shift_(cell_shift(frame)) {
    nearest_m_ = Image<float>(((frame.color_camera.width - 1) >> shift_) + 1,
                              ((frame.color_camera.height - 1) >> shift_) + 1,
                              std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < seen.pixel.size(); ++i) {
      if (seen.pixel[i] == kOutside) continue;
      float& nearest = nearest_m_[cell(seen.pixel[i])];
      nearest = std::min(nearest, seen.z_m[i]);
    }
  }

  float at(std::int32_t pixel) const { return nearest_m_[cell(pixel)]; }

 private:
  static int cell_shift(const Frame& frame) {
    const float scale = std::max(frame.color_camera.fx / frame.depth_camera.fx,
                                 frame.color_camera.fy / frame.depth_camera.fy);
    int shift = 0;
    while (static_cast<float>(1 << shift) < scale && shift < 8) ++shift;
    return shift;
  }
  std::size_t cell(std::int32_t pixel) const {
    return static_cast<std::size_t>((packed_y(pixel) >> shift_) * nearest_m_.width() +
                                    (packed_x(pixel) >> shift_));
  }

  int shift_;
  Image<float> nearest_m_;
};

template <class Pixel>
Image<Pixel> look_up(const Image<Pixel>& image, const Image<std::int32_t>& index) {
  auto result = Image<Pixel>::unset(index.width(), index.height());
  parallel_for_ranges(
      index.size(), kRegisteredRowsPerTask * static_cast<std::size_t>(index.width()),
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          result[i] = index[i] >= 0 ? image[static_cast<std::size_t>(index[i])] : Pixel{};
      });
  return result;
}

}  // namespace

Registration::Registration(const Frame& frame, const DepthImage& depth, float occlusion_margin_m)
    : color_width_(frame.color_camera.width),
      color_height_(frame.color_camera.height),
      color_index_(Image<std::int32_t>::unset(depth.width(), depth.height())) {
  OVIMAP_ASSERT(depth.same_size(frame.depth));
  const std::size_t grain = kRegisteredRowsPerTask * static_cast<std::size_t>(depth.width());
  if (frame.registered()) {
    parallel_for(color_index_.size(), grain, [&](std::size_t i) {
      color_index_[i] = depth[i] > 0 ? static_cast<std::int32_t>(i) : kNoColor;
    });
    return;
  }
  const Projected seen = project(frame, depth);
  const NearestSurface surface(frame, seen);
  const int color_width = frame.color_camera.width;
  parallel_for(color_index_.size(), grain, [&](std::size_t i) {
    const std::int32_t pixel = seen.pixel[i];
    const bool hidden = pixel == kOutside || surface.at(pixel) < seen.z_m[i] - occlusion_margin_m;
    color_index_[i] = hidden ? kNoColor : packed_y(pixel) * color_width + packed_x(pixel);
  });
}

RgbImage Registration::color_at_depth(const RgbImage& color) const {
  OVIMAP_ASSERT(color.width() == color_width_ && color.height() == color_height_);
  return look_up(color, color_index_);
}

IdImage Registration::ids_at_depth(const IdImage& ids) const {
  OVIMAP_ASSERT(ids.width() == color_width_ && ids.height() == color_height_);
  return look_up(ids, color_index_);
}

}  // namespace ovimap
