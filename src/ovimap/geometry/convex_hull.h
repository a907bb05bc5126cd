// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace ovimap {

/// Twice the signed area of the triangle a, b, c; positive when c is left of a -> b.
inline float turn(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Corners of the smallest convex polygon around the points, counter-clockwise (Andrew's monotone
/// chain). Fewer than three come back when the points lie on a line.
std::vector<Eigen::Vector2f> convex_hull(std::vector<Eigen::Vector2f> points);

struct PlaneRectangle {
  Eigen::Vector2f center = Eigen::Vector2f::Zero();
  Eigen::Vector2f along = Eigen::Vector2f::UnitX();  ///< unit length, of the first side
  Eigen::Vector2f sides = Eigen::Vector2f::Zero();   ///< lengths along it, and across

  Eigen::Vector2f across() const { return {-along.y(), along.x()}; }
};

/// The smallest rectangle around a convex polygon: one of its sides lies along an edge (Freeman and
/// Shapira 1975). Of equals the first; of no edges the one without sides.
PlaneRectangle smallest_rectangle(std::span<const Eigen::Vector2f> hull);

}  // namespace ovimap
