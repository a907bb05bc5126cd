// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/relations/footprint.h"

#include <algorithm>
#include <limits>

namespace ovimap {

namespace {

const Eigen::Vector2f& next_corner(const Footprint& footprint, std::size_t i) {
  return footprint[i + 1 < footprint.size() ? i + 1 : 0];
}

Eigen::Vector2f nearest_on_segment(const Eigen::Vector2f& a, const Eigen::Vector2f& b,
                                   const Eigen::Vector2f& point) {
  const Eigen::Vector2f along = b - a;
  const float length2 = along.squaredNorm();
  if (length2 == 0.f) return a;
  return a + std::clamp(along.dot(point - a) / length2, 0.f, 1.f) * along;
}

/// The part of `polygon` left of the line a -> b (Sutherland and Hodgman 1974).
void clip(const Footprint& polygon, const Eigen::Vector2f& a, const Eigen::Vector2f& b,
          Footprint& kept) {
  kept.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2f &p = polygon[i], &q = next_corner(polygon, i);
    const float side_p = turn(a, b, p), side_q = turn(a, b, q);
    if (side_p >= 0.f) kept.push_back(p);
    if ((side_p > 0.f && side_q < 0.f) || (side_p < 0.f && side_q > 0.f))
      kept.push_back(p + side_p / (side_p - side_q) * (q - p));
  }
}

Footprint overlap_of(const Footprint& a, const Footprint& b) {
  // The one of more corners is clipped: the first edges of the other leave few of them.
  const Footprint& by = a.size() < b.size() ? a : b;
  Footprint shared = a.size() < b.size() ? b : a, kept;
  for (std::size_t i = 0; i < by.size() && !shared.empty(); ++i) {
    clip(shared, by[i], next_corner(by, i), kept);
    std::swap(shared, kept);
  }
  return shared;
}

}  // namespace

float area_m2(const Footprint& footprint) {
  float twice = 0;
  for (std::size_t i = 1; i + 1 < footprint.size(); ++i)
    twice += turn(footprint[0], footprint[i], footprint[i + 1]);
  return 0.5f * twice;
}

float perimeter_m(const Footprint& footprint) {
  float length = 0;
  for (std::size_t i = 0; i < footprint.size(); ++i)
    length += (next_corner(footprint, i) - footprint[i]).norm();
  return length;
}

float smallest_width_m(const Footprint& footprint) {
  float smallest = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < footprint.size(); ++i) {
    const Eigen::Vector2f &a = footprint[i], &b = next_corner(footprint, i);
    float farthest = 0;
    for (const Eigen::Vector2f& corner : footprint)
      farthest = std::max(farthest, turn(a, b, corner));
    smallest = std::min(smallest, farthest / (b - a).norm());
  }
  return smallest;
}

float overlap_m2(const Footprint& a, const Footprint& b) {
  return area_m2(overlap_of(a, b));
}

Eigen::Vector2f nearest_point(const Footprint& footprint, const Eigen::Vector2f& point) {
  bool inside = true;
  float best = std::numeric_limits<float>::max();
  Eigen::Vector2f nearest = point;
  for (std::size_t i = 0; i < footprint.size(); ++i) {
    const Eigen::Vector2f &a = footprint[i], &b = next_corner(footprint, i);
    if (turn(a, b, point) >= 0.f) continue;
    inside = false;
    const Eigen::Vector2f candidate = nearest_on_segment(a, b, point);
    const float distance2 = (candidate - point).squaredNorm();
    if (distance2 >= best) continue;
    best = distance2;
    nearest = candidate;
  }
  return inside ? point : nearest;
}

float distance_m(const Footprint& footprint, const Eigen::Vector2f& point) {
  return (nearest_point(footprint, point) - point).norm();
}

float distance_m(const Footprint& a, const Footprint& b) {
  if (!overlap_of(a, b).empty()) return 0.f;
  float smallest = std::numeric_limits<float>::max();
  for (const Eigen::Vector2f& corner : a) smallest = std::min(smallest, distance_m(b, corner));
  for (const Eigen::Vector2f& corner : b) smallest = std::min(smallest, distance_m(a, corner));
  return smallest;
}

}  // namespace ovimap
