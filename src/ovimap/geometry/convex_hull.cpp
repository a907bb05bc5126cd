// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/geometry/convex_hull.h"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

namespace ovimap {

float turn(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c) {
  const Eigen::Vector2f u = b - a, v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

std::vector<Eigen::Vector2f> convex_hull(std::vector<Eigen::Vector2f> points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Eigen::Vector2f> hull;
  const auto add_chain = [&hull](auto begin, auto end) {
    const std::size_t base = hull.size();
    for (auto at = begin; at != end; ++at) {
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), *at) <= 0.f)
        hull.pop_back();
      hull.push_back(*at);
    }
    hull.pop_back();  // the other chain begins with it
  };
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  return hull;
}

PlaneRectangle smallest_rectangle(std::span<const Eigen::Vector2f> hull) {
  PlaneRectangle best;
  float least = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2f edge = hull[(i + 1) % hull.size()] - hull[i];
    if (edge.isZero()) continue;
    PlaneRectangle rectangle;
    rectangle.along = edge.normalized();
    const Eigen::Vector2f across = rectangle.across();
    Eigen::AlignedBox2f box;
    for (const Eigen::Vector2f& corner : hull)
      box.extend(Eigen::Vector2f(rectangle.along.dot(corner), across.dot(corner)));
    rectangle.sides = box.sizes();
    if (rectangle.sides.prod() >= least) continue;
    least = rectangle.sides.prod();
    const Eigen::Vector2f middle = 0.5f * (box.min() + box.max());
    rectangle.center = middle.x() * rectangle.along + middle.y() * across;
    best = rectangle;
  }
  return best;
}

}  // namespace ovimap
