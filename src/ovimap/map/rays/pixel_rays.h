// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ovimap/base/lanes.h"
#include "ovimap/geometry/camera.h"

namespace ovimap {

/// The viewing rays of all pixels in the world frame, with unit depth along the optical axis: the
/// sum of a part by column and a part by row.
class PixelRays {
 public:
  PixelRays(const PinholeCamera& camera, const Eigen::Matrix3f& world_from_camera)
      : camera_(camera),
        rotation_(world_from_camera),
        column_x_(static_cast<std::size_t>(camera.width + kLanes - 1)),
        column_y_(column_x_.size()),
        column_z_(column_x_.size()) {
    for (std::size_t x = 0; x < column_x_.size(); ++x) {
      const Eigen::Vector3f part =
          rotation_.col(0) * ((static_cast<float>(x) - camera.cx) / camera.fx);
      column_x_[x] = part.x(), column_y_[x] = part.y(), column_z_[x] = part.z();
    }
  }

  /// Rays of an image row: columns[x] + part. Those beyond its end that lanes from a pixel on reach
  /// can be read as well.
  struct Row {
    const float *column_x, *column_y, *column_z;
    Eigen::Vector3f part;
  };
  Row row(int y) const {
    return {
        column_x_.data(), column_y_.data(), column_z_.data(),
        rotation_.col(1) * ((static_cast<float>(y) - camera_.cy) / camera_.fy) + rotation_.col(2)};
  }
  Eigen::Vector3f at(int x, int y) const {
    const auto column = static_cast<std::size_t>(x);
    return Eigen::Vector3f(column_x_[column], column_y_[column], column_z_[column]) + row(y).part;
  }

 private:
  PinholeCamera camera_;
  Eigen::Matrix3f rotation_;
  std::vector<float> column_x_, column_y_, column_z_;
};

}  // namespace ovimap
