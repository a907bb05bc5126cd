// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/geometry/surface_distance.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace ovimap {

namespace {

constexpr std::size_t kTrianglesOfLeaf = 4;

double squared_distance_to_edge(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                                const Eigen::Vector3d& b) {
  const Eigen::Vector3d edge = b - a;
  const double length_squared = edge.squaredNorm();
  const double along = length_squared > 0 ? (point - a).dot(edge) / length_squared : 0;
  return (a + std::clamp(along, 0.0, 1.0) * edge - point).squaredNorm();
}

}  // namespace

double squared_distance(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                        const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double normal_squared = normal.squaredNorm();
  const auto left_of = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return (to - from).cross(point - from).dot(normal) >= 0;
  };
  if (normal_squared > 0 && left_of(a, b) && left_of(b, c) && left_of(c, a)) {
    const double height = (point - a).dot(normal);
    return height * height / normal_squared;
  }
  return std::min({squared_distance_to_edge(point, a, b), squared_distance_to_edge(point, b, c),
                   squared_distance_to_edge(point, c, a)});
}

SurfaceDistance::SurfaceDistance(const Mesh& mesh) {
  triangles_.reserve(mesh.triangles.empty() ? mesh.vertices.size() : mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles)
    triangles_.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
  if (mesh.triangles.empty())
    for (const Eigen::Vector3f& vertex : mesh.vertices)
      triangles_.push_back({vertex, vertex, vertex});
  if (triangles_.empty()) return;
  // Halving n triangles down to leaves of kTrianglesOfLeaf takes ceil(log2(n / kTrianglesOfLeaf))
  // levels.
  const std::size_t leaves =
      std::bit_ceil((triangles_.size() + kTrianglesOfLeaf - 1) / kTrianglesOfLeaf);
  boxes_.resize(2 * leaves - 1);
  build(0, {0, triangles_.size()});
}

void SurfaceDistance::build(std::size_t node, Range range) {
  Eigen::AlignedBox3f box, centers;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const Triangle& t = triangles_[i];
    box.extend(t.a).extend(t.b).extend(t.c);
    centers.extend((t.a + t.b + t.c) / 3);
  }
  boxes_[node] = box;
  if (range.end - range.begin <= kTrianglesOfLeaf) return;
  int axis = 0;
  centers.sizes().maxCoeff(&axis);
  const std::size_t middle = range.begin + (range.end - range.begin) / 2;
  const auto at = [this](std::size_t i) {
    return triangles_.begin() + static_cast<std::ptrdiff_t>(i);
  };
  std::nth_element(at(range.begin), at(middle), at(range.end),
                   [axis](const Triangle& s, const Triangle& t) {
                     return s.a[axis] + s.b[axis] + s.c[axis] < t.a[axis] + t.b[axis] + t.c[axis];
                   });
  build(2 * node + 1, {range.begin, middle});
  build(2 * node + 2, {middle, range.end});
}

void SurfaceDistance::search(std::size_t node, Range range, const Eigen::Vector3f& point,
                             double& best) const {
  if (range.end - range.begin <= kTrianglesOfLeaf) {
    const Eigen::Vector3d p = point.cast<double>();
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Triangle& t = triangles_[i];
      best = std::min(
          best, squared_distance(p, t.a.cast<double>(), t.b.cast<double>(), t.c.cast<double>()));
    }
    return;
  }
  const std::size_t middle = range.begin + (range.end - range.begin) / 2;
  const std::size_t left = 2 * node + 1, right = 2 * node + 2;
  const float to_left = boxes_[left].squaredExteriorDistance(point);
  const float to_right = boxes_[right].squaredExteriorDistance(point);
  const auto visit_left = [&] {
    if (to_left <= best) search(left, {range.begin, middle}, point, best);
  };
  const auto visit_right = [&] {
    if (to_right <= best) search(right, {middle, range.end}, point, best);
  };
  if (to_left <= to_right)
    visit_left(), visit_right();
  else
    visit_right(), visit_left();
}

std::optional<float> SurfaceDistance::find(const Eigen::Vector3f& point, float limit_m) const {
  if (triangles_.empty() || !point.allFinite()) return std::nullopt;
  const double limit_squared = static_cast<double>(limit_m) * limit_m;
  // Just above the limit, so that a triangle exactly at the limit still lowers it.
  double best = std::nextafter(limit_squared, 2 * limit_squared + 1);
  search(0, {0, triangles_.size()}, point, best);
  if (best > limit_squared) return std::nullopt;
  return static_cast<float>(std::sqrt(best));
}

}  // namespace ovimap
