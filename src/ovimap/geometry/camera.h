// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace ovimap {

/// Pinhole camera without distortion: x right, y down, z forward. Integer pixel coordinates are
/// pixel centres. All intrinsics in pixels.
struct PinholeCamera {
  int width = 0, height = 0;
  float fx = 0, fy = 0, cx = 0, cy = 0;

  bool operator==(const PinholeCamera&) const = default;

  /// Usable: positive size and focal lengths, everything finite.
  bool valid() const;

  /// The point at `depth_m` along the optical axis that projects to pixel (u, v).
  Eigen::Vector3f unproject(float u, float v, float depth_m) const {
    return {(u - cx) / fx * depth_m, (v - cy) / fy * depth_m, depth_m};
  }

  /// Pixel coordinates of a point with z > 0; they may lie outside the image.
  Eigen::Vector2f project(const Eigen::Vector3f& point) const {
    return {fx * point.x() / point.z() + cx, fy * point.y() / point.z() + cy};
  }

  /// The same view at another image size.
  PinholeCamera scaled_to(int new_width, int new_height) const;
};

}  // namespace ovimap
