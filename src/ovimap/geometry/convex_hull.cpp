// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/geometry/convex_hull.h"

#include <algorithm>
#include <array>
#include <limits>

#include <Eigen/Geometry>

namespace ovimap {

float turn(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c) {
  const Eigen::Vector2f u = b - a, v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

namespace {

/// Drops most of the points that lie inside the octagon of those farthest out along eight
/// directions: none of them is a corner of the hull, and sorting them is what a hull costs (Akl and
/// Toussaint 1978, "A fast convex hull algorithm").
void drop_inner(std::vector<Eigen::Vector2f>& points) {
  constexpr std::size_t kWorthwhile = 64;
  if (points.size() < kWorthwhile) return;
  std::array<Eigen::Vector2f, 8> octagon;  // counter-clockwise
  octagon.fill(points.front());
  constexpr std::array<std::array<float, 2>, 8> kOutward = {
      {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
  for (const Eigen::Vector2f& point : points)
    for (std::size_t i = 0; i < octagon.size(); ++i) {
      const Eigen::Vector2f outward(kOutward[i][0], kOutward[i][1]);
      if (outward.dot(point) > outward.dot(octagon[i])) octagon[i] = point;
    }
  // Well inside: what rounding could put on the wrong side of an edge stays.
  const float slack =
      1e-5f * ((octagon[0] - octagon[4]).squaredNorm() + (octagon[2] - octagon[6]).squaredNorm());
  std::erase_if(points, [&](const Eigen::Vector2f& point) {
    for (std::size_t i = 0; i < octagon.size(); ++i) {
      const Eigen::Vector2f &a = octagon[i], &b = octagon[(i + 1) % octagon.size()];
      if (a != b && turn(a, b, point) <= slack) return false;
    }
    return true;
  });
}

}  // namespace

std::vector<Eigen::Vector2f> convex_hull(std::vector<Eigen::Vector2f> points) {
  drop_inner(points);
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
