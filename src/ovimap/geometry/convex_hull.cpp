// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/geometry/convex_hull.h"

#include <algorithm>
#include <array>
#include <limits>

#include <Eigen/Geometry>

namespace ovimap {

namespace {

using Eight = Eigen::Array<float, 8, 1>;  // of a point all at once

/// The points farthest out along eight directions, counter-clockwise; the first of equals.
std::array<Eigen::Vector2f, 8> octagon_of(std::span<const Eigen::Vector2f> points) {
  const Eight outward_x{{1, 1, 0, -1, -1, -1, 0, 1}}, outward_y{{0, 1, 1, 1, 0, -1, -1, -1}};
  std::array<Eigen::Vector2f, 8> farthest;
  farthest.fill(points.front());
  Eight most = Eight::Constant(std::numeric_limits<float>::lowest());
  for (const Eigen::Vector2f& point : points) {
    const Eight out = outward_x * point.x() + outward_y * point.y();
    if ((out <= most).all()) continue;
    for (Eigen::Index i = 0; i < out.size(); ++i)
      if (out[i] > most[i]) most[i] = out[i], farthest[static_cast<std::size_t>(i)] = point;
  }
  return farthest;
}

/// Drops most of the points that lie inside the octagon of those farthest out along eight
/// directions: none of them is a corner of the hull, and sorting them is what a hull costs (Akl and
/// Toussaint 1978, "A fast convex hull algorithm").
void drop_inner(std::vector<Eigen::Vector2f>& points) {
  constexpr std::size_t kWorthwhile = 64;
  if (points.size() < kWorthwhile) return;
  const std::array<Eigen::Vector2f, 8> octagon = octagon_of(points);
  // Well inside: what rounding could put on the wrong side of an edge stays.
  const float slack =
      1e-5f * ((octagon[0] - octagon[4]).squaredNorm() + (octagon[2] - octagon[6]).squaredNorm());
  // Twice the area of the triangle of an edge and the point, as in turn(), of all edges.
  Eight edge_x, edge_y, least;
  for (std::size_t i = 0; i < octagon.size(); ++i) {
    const Eigen::Vector2f from = octagon[i] - octagon[0];
    const Eigen::Vector2f edge = octagon[(i + 1) % octagon.size()] - octagon[i];
    const auto row = static_cast<Eigen::Index>(i);
    edge_x[row] = edge.x(), edge_y[row] = edge.y();
    least[row] = edge.isZero(0.f) ? -1.f : edge.x() * from.y() - edge.y() * from.x() + slack;
  }
  std::erase_if(points, [&](const Eigen::Vector2f& point) {
    const Eigen::Vector2f at = point - octagon[0];
    return (edge_x * at.y() - edge_y * at.x() > least).all();
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
