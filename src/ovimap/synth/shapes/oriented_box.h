// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>

namespace ovimap {

/// An upright box that may be turned about the vertical: what a piece of furniture occupies.
struct OrientedBox {
  Eigen::Vector2f center_m = Eigen::Vector2f::Zero();  ///< on the floor plan
  Eigen::Vector2f half_m = Eigen::Vector2f::Zero();    ///< half width, half depth, before turning
  float yaw_rad = 0;                                   ///< counter-clockwise seen from above
  float bottom_m = 0, top_m = 0;

  Eigen::Vector2f x_axis() const;
  Eigen::Vector2f y_axis() const;
  std::array<Eigen::Vector2f, 4> corners() const;
  Eigen::Vector2f world_from_box(const Eigen::Vector2f& point) const;
  /// It, turned counter-clockwise about a point of the floor plan.
  OrientedBox turned(const Eigen::Vector2f& about_m, float by_rad) const;

  /// Whether the footprint lies in [margin, size - margin] on the floor plan.
  bool inside(const Eigen::Vector2f& room_size_m, float margin_m) const;
};

/// How deep two boxes overlap along the direction in which they overlap least, metres; negative:
/// the gap between them (at least along one axis). Touching is zero.
float overlap(const OrientedBox& a, const OrientedBox& b);

/// The same for the footprints alone, whatever their heights.
float footprint_overlap(const OrientedBox& a, const OrientedBox& b);

}  // namespace ovimap
