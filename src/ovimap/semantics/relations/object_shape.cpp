// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/relations/object_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

constexpr float kNoiseShare = 0.005f;     // of the points, at the top and at the bottom
constexpr float kPointRadius_m = 0.005f;  // half the size of a surface point

/// Never degenerate, where every point has a size.
Footprint footprint_of(const std::vector<Eigen::Vector3f>& points, float radius_m) {
  std::vector<Eigen::Vector2f> flat;
  flat.reserve(points.size());
  for (const Eigen::Vector3f& point : points) flat.push_back(point.head<2>());
  std::vector<Eigen::Vector2f> corners;
  for (const Eigen::Vector2f& corner : convex_hull(std::move(flat)))
    for (const float x : {-radius_m, radius_m})
      for (const float y : {-radius_m, radius_m}) corners.push_back(corner + Eigen::Vector2f(x, y));
  Footprint hull = convex_hull(std::move(corners));
  // Relations take the corners of both for each pair. A thing that maps see has some dozens.
  constexpr std::size_t kMostCorners = 256;
  if (hull.size() <= kMostCorners) return hull;
  Footprint fewer;
  for (std::size_t i = 0; i < kMostCorners; ++i)
    fewer.push_back(hull[i * hull.size() / kMostCorners]);
  return fewer;
}

/// Distance to the interval [low, high].
float outside(float value, float low, float high) {
  return std::max({low - value, value - high, 0.f});
}

float prism_gap_m(const ObjectShape& a, const ObjectShape& b) {
  const float vertical = std::max({b.bottom_m - a.top_m, a.bottom_m - b.top_m, 0.f});
  return std::hypot(distance_m(a.footprint, b.footprint), vertical);
}

/// Calls `visit(points)` for the runs of a group that `counts(box)`.
template <class Counts, class Visit>
void visit_group(const ObjectShape& shape, std::size_t group, const Counts& counts,
                 const Visit& visit) {
  if (!counts(shape.groups[group])) return;
  const std::size_t begin = group * ObjectShape::kRunsOfGroup;
  for (std::size_t run = begin;
       run < std::min(begin + ObjectShape::kRunsOfGroup, shape.runs.size()); ++run)
    if (counts(shape.runs[run])) visit(shape.run_points(run));
}

/// Smallest distance from a point of the shape's surface to the prism. Squares are compared, and
/// what is farther than the nearest so far is left out, group by group.
float surface_gap_m(const ObjectShape& shape, const ObjectShape& prism) {
  const Eigen::AlignedBox3f bounds = upright_box(prism);
  float smallest2 = std::numeric_limits<float>::max();
  const auto nearer = [&](const Eigen::AlignedBox3f& box) {
    return bounds.squaredExteriorDistance(box) < smallest2;
  };
  const auto visit = [&](std::span<const Eigen::Vector3f> points) {
    for (const Eigen::Vector3f& point : points) {
      if (bounds.squaredExteriorDistance(point) >= smallest2) continue;
      const Eigen::Vector2f flat = point.head<2>();
      const float aside2 = (nearest_point(prism.footprint, flat) - flat).squaredNorm();
      const float vertical = outside(point.z(), prism.bottom_m, prism.top_m);
      smallest2 = std::min(smallest2, aside2 + vertical * vertical);
    }
  };
  // The nearest first: what it holds spares looking into most others.
  const auto nearest = std::min_element(
      shape.groups.begin(), shape.groups.end(), [&](const auto& one, const auto& other) {
        return bounds.squaredExteriorDistance(one) < bounds.squaredExteriorDistance(other);
      });
  const auto first = static_cast<std::size_t>(nearest - shape.groups.begin());
  visit_group(shape, first, nearer, visit);
  for (std::size_t group = 0; group < shape.groups.size(); ++group)
    if (group != first) visit_group(shape, group, nearer, visit);
  return std::sqrt(smallest2);
}

/// Boxes around each `length` of `parts`, points or boxes.
template <class Part>
std::vector<Eigen::AlignedBox3f> boxes_around(const std::vector<Part>& parts, std::size_t length) {
  std::vector<Eigen::AlignedBox3f> boxes((parts.size() + length - 1) / length);
  for (std::size_t i = 0; i < parts.size(); ++i) boxes[i / length].extend(parts[i]);
  return boxes;
}

}  // namespace

std::span<const Eigen::Vector3f> ObjectShape::run_points(std::size_t run) const {
  const std::size_t begin = run * kPointsOfRun;
  return std::span(surface).subspan(begin, std::min(kPointsOfRun, surface.size() - begin));
}

Eigen::Matrix3f ground_from_world(const Eigen::Vector3f& up_in_world) {
  const Eigen::Vector3f up = up_in_world.normalized();
  Eigen::Index least = 0;
  up.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3f east = Eigen::Vector3f::Unit(least).cross(up).normalized();
  Eigen::Matrix3f rows;
  rows << east.transpose(), up.cross(east).transpose(), up.transpose();
  return rows;
}

ObjectShape shape_of_points(const Eigen::Matrix3f& ground_from_world,
                            std::span<const Eigen::Vector3f> points_in_world) {
  OVIMAP_ASSERT(!points_in_world.empty());
  std::vector<Eigen::Vector3f> points;
  points.reserve(points_in_world.size());
  for (const Eigen::Vector3f& point : points_in_world) points.push_back(ground_from_world * point);
  std::vector<float> heights(points.size());
  std::transform(points.begin(), points.end(), heights.begin(),
                 [](const auto& p) { return p.z(); });
  const auto cut = static_cast<std::ptrdiff_t>(kNoiseShare * static_cast<float>(heights.size()));
  const auto lowest = heights.begin() + cut, highest = heights.end() - 1 - cut;
  std::nth_element(heights.begin(), lowest, heights.end());
  const float low = *lowest;  // the next selection moves it
  std::nth_element(lowest, highest, heights.end());
  const float high = *highest;
  std::erase_if(points, [&](const auto& p) { return p.z() < low || p.z() > high; });

  ObjectShape shape;
  shape.bottom_m = low - kPointRadius_m;
  shape.top_m = high + kPointRadius_m;
  for (const Eigen::Vector3f& point : points) shape.centroid += point;
  shape.centroid /= static_cast<float>(points.size());
  shape.footprint = footprint_of(points, kPointRadius_m);
  shape.surface = std::move(points);
  shape.runs = boxes_around(shape.surface, ObjectShape::kPointsOfRun);
  shape.groups = boxes_around(shape.runs, ObjectShape::kRunsOfGroup);
  return shape;
}

ObjectShape shape_of_box(const Eigen::Matrix3f& ground_from_world,
                         const Eigen::AlignedBox3f& box_in_world,
                         const Eigen::Vector3f& centroid_in_world) {
  Eigen::AlignedBox3f box = box_in_world;
  if (box.isEmpty()) box.extend(centroid_in_world);
  std::vector<Eigen::Vector3f> corners;
  for (int corner = 0; corner < 8; ++corner)
    corners.push_back(ground_from_world *
                      box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(corner)));
  const auto [low, high] = std::minmax_element(
      corners.begin(), corners.end(), [](const auto& a, const auto& b) { return a.z() < b.z(); });
  ObjectShape shape;
  shape.bottom_m = low->z();
  shape.top_m = std::max(high->z(), low->z() + kPointRadius_m);
  shape.centroid = ground_from_world * centroid_in_world;
  shape.footprint = footprint_of(corners, 0.f);
  if (shape.footprint.size() < 3) shape.footprint = footprint_of(corners, kPointRadius_m);
  return shape;
}

Eigen::AlignedBox3f upright_box(const ObjectShape& shape) {
  Eigen::AlignedBox2f flat;
  for (const Eigen::Vector2f& corner : shape.footprint) flat.extend(corner);
  return {Eigen::Vector3f(flat.min().x(), flat.min().y(), shape.bottom_m),
          Eigen::Vector3f(flat.max().x(), flat.max().y(), shape.top_m)};
}

float gap_m(const ObjectShape& a, const ObjectShape& b) {
  // Each of these is at most the true gap (but for the thinning), so the largest is the best. A
  // surface lies within its prism, so its gap is never the smaller one.
  if (a.surface.empty() && b.surface.empty()) return prism_gap_m(a, b);
  float gap = 0;
  if (!b.surface.empty()) gap = std::max(gap, surface_gap_m(b, a));
  if (!a.surface.empty()) gap = std::max(gap, surface_gap_m(a, b));
  return gap;
}

float support_height_m(const ObjectShape& above, const ObjectShape& below, float margin_m) {
  float highest = std::numeric_limits<float>::lowest();
  if (below.surface.empty())
    return distance_m(above.footprint, below.footprint) <= margin_m ? below.top_m : highest;
  const Eigen::Vector3f margin(margin_m, margin_m, 0.f);
  Eigen::AlignedBox3f column = upright_box(above);  // where its support can be
  column.min() -= margin;
  column.max() += margin;
  column.max().z() = above.middle_m();
  column.min().z() = std::numeric_limits<float>::lowest();
  const auto may_be = [&](const Eigen::AlignedBox3f& box) {
    return box.max().z() > highest && column.intersects(box);
  };
  for (std::size_t group = 0; group < below.groups.size(); ++group)
    visit_group(below, group, may_be, [&](std::span<const Eigen::Vector3f> points) {
      for (const Eigen::Vector3f& point : points)
        if (point.z() > highest && column.contains(point) &&
            distance_m(above.footprint, point.head<2>()) <= margin_m)
          highest = point.z();
    });
  return highest;
}

}  // namespace ovimap
