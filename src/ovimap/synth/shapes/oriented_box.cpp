// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/shapes/oriented_box.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ovimap {

Eigen::Vector2f OrientedBox::x_axis() const {
  return {std::cos(yaw_rad), std::sin(yaw_rad)};
}
Eigen::Vector2f OrientedBox::y_axis() const {
  return {-std::sin(yaw_rad), std::cos(yaw_rad)};
}

Eigen::Vector2f OrientedBox::world_from_box(const Eigen::Vector2f& point) const {
  return center_m + point.x() * x_axis() + point.y() * y_axis();
}

OrientedBox OrientedBox::turned(const Eigen::Vector2f& about_m, float by_rad) const {
  OrientedBox box = *this;
  box.center_m = about_m + Eigen::Rotation2Df(by_rad) * (center_m - about_m);
  box.yaw_rad += by_rad;
  return box;
}

std::array<Eigen::Vector2f, 4> OrientedBox::corners() const {
  const float x = half_m.x(), y = half_m.y();
  return {world_from_box({-x, -y}), world_from_box({x, -y}), world_from_box({x, y}),
          world_from_box({-x, y})};
}

bool OrientedBox::inside(const Eigen::Vector2f& room_size_m, float margin_m) const {
  for (const Eigen::Vector2f& corner : corners())
    for (int i = 0; i < 2; ++i)
      if (corner[i] < margin_m || corner[i] > room_size_m[i] - margin_m) return false;
  return true;
}

float footprint_overlap(const OrientedBox& a, const OrientedBox& b) {
  // Separating axes: two rectangles are apart exactly when they are so along a side of one of them.
  float least = std::numeric_limits<float>::infinity();
  const auto corners_a = a.corners(), corners_b = b.corners();
  for (const Eigen::Vector2f& axis : {a.x_axis(), a.y_axis(), b.x_axis(), b.y_axis()}) {
    const auto range = [&axis](const std::array<Eigen::Vector2f, 4>& corners) {
      const auto [low, high] = std::minmax(
          {axis.dot(corners[0]), axis.dot(corners[1]), axis.dot(corners[2]), axis.dot(corners[3])});
      return std::array{low, high};
    };
    const auto [low_a, high_a] = range(corners_a);
    const auto [low_b, high_b] = range(corners_b);
    least = std::min(least, std::min(high_a, high_b) - std::max(low_a, low_b));
  }
  return least;
}

float overlap(const OrientedBox& a, const OrientedBox& b) {
  const float vertical = std::min(a.top_m, b.top_m) - std::max(a.bottom_m, b.bottom_m);
  return std::min(vertical, footprint_overlap(a, b));
}

}  // namespace ovimap
