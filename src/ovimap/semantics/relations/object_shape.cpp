// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/relations/object_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ovimap/base/config.h"
#include "ovimap/map/voxels/voxel_block.h"

namespace ovimap {

namespace {

/// The first point of each cell of a grid, in the order of the cells.
std::vector<Eigen::Vector3f> thinned(const std::vector<Eigen::Vector3f>& points, float spacing_m) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> cells(points.size());
  for (std::uint32_t i = 0; i < cells.size(); ++i)
    cells[i] = {pack_index(floor_to_int(points[i] / spacing_m)), i};
  std::sort(cells.begin(), cells.end());
  std::vector<Eigen::Vector3f> kept;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (i == 0 || cells[i].first != cells[i - 1].first) kept.push_back(points[cells[i].second]);
  return kept;
}

/// Never degenerate, since every point has a size.
Footprint footprint_of(const std::vector<Eigen::Vector3f>& points, float radius_m) {
  std::vector<Eigen::Vector2f> flat;
  flat.reserve(points.size());
  for (const Eigen::Vector3f& point : points) flat.push_back(point.head<2>());
  std::vector<Eigen::Vector2f> corners;
  for (const Eigen::Vector2f& corner : convex_hull(std::move(flat)))
    for (const float x : {-radius_m, radius_m})
      for (const float y : {-radius_m, radius_m}) corners.push_back(corner + Eigen::Vector2f(x, y));
  return convex_hull(std::move(corners));
}

/// Distance to the interval [low, high].
float outside(float value, float low, float high) {
  return std::max({low - value, value - high, 0.f});
}

float prism_gap_m(const ObjectShape& a, const ObjectShape& b) {
  const float vertical = std::max({b.bottom_m - a.top_m, a.bottom_m - b.top_m, 0.f});
  return std::hypot(distance_m(a.footprint, b.footprint), vertical);
}

/// Smallest distance from a point of the surface to the prism.
float surface_gap_m(const std::vector<Eigen::Vector3f>& surface, const ObjectShape& prism) {
  Eigen::AlignedBox2f bounds;
  for (const Eigen::Vector2f& corner : prism.footprint) bounds.extend(corner);
  float smallest = std::numeric_limits<float>::max();
  for (const Eigen::Vector3f& point : surface) {
    const float vertical = outside(point.z(), prism.bottom_m, prism.top_m);
    const Eigen::Vector2f flat = point.head<2>();
    if (std::hypot(bounds.exteriorDistance(flat), vertical) >= smallest) continue;
    smallest = std::min(smallest, std::hypot(distance_m(prism.footprint, flat), vertical));
  }
  return smallest;
}

}  // namespace

void list_fields(ObjectShapeConfig& config, ConfigFields& fields) {
  fields.add("noise_share", config.noise_share, 0.f, 0.4f,
             "share of an object's points cut off at the top and at the bottom");
  fields.add("point_radius_m", config.point_radius_m, 1e-4f, 1.f,
             "half the size of a surface point, metres");
  fields.add("surface_spacing_m", config.surface_spacing_m, 1e-3f, 1.f,
             "surface points nearer to each other are thinned, metres");
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
                            std::span<const Eigen::Vector3f> points_in_world,
                            const ObjectShapeConfig& config) {
  OVIMAP_ASSERT(!points_in_world.empty());
  std::vector<Eigen::Vector3f> points;
  points.reserve(points_in_world.size());
  for (const Eigen::Vector3f& point : points_in_world) points.push_back(ground_from_world * point);
  std::vector<float> heights(points.size());
  std::transform(points.begin(), points.end(), heights.begin(),
                 [](const auto& p) { return p.z(); });
  const auto cut =
      static_cast<std::ptrdiff_t>(config.noise_share * static_cast<float>(heights.size()));
  const auto lowest = heights.begin() + cut, highest = heights.end() - 1 - cut;
  std::nth_element(heights.begin(), lowest, heights.end());
  const float low = *lowest;  // the next selection moves it
  std::nth_element(lowest, highest, heights.end());
  const float high = *highest;
  std::erase_if(points, [&](const auto& p) { return p.z() < low || p.z() > high; });

  ObjectShape shape;
  shape.bottom_m = low - config.point_radius_m;
  shape.top_m = high + config.point_radius_m;
  for (const Eigen::Vector3f& point : points) shape.centroid += point;
  shape.centroid /= static_cast<float>(points.size());
  shape.surface = thinned(points, config.surface_spacing_m);
  shape.footprint = footprint_of(points, config.point_radius_m);
  return shape;
}

ObjectShape shape_of_box(const Eigen::Matrix3f& ground_from_world,
                         const Eigen::AlignedBox3f& box_in_world,
                         const Eigen::Vector3f& centroid_in_world,
                         const ObjectShapeConfig& config) {
  std::vector<Eigen::Vector3f> corners;
  for (int corner = 0; corner < 8; ++corner)
    corners.push_back(ground_from_world *
                      box_in_world.corner(static_cast<Eigen::AlignedBox3f::CornerType>(corner)));
  const auto [low, high] = std::minmax_element(
      corners.begin(), corners.end(), [](const auto& a, const auto& b) { return a.z() < b.z(); });
  ObjectShape shape;
  shape.bottom_m = low->z();
  shape.top_m = std::max(high->z(), low->z() + config.point_radius_m);
  shape.centroid = ground_from_world * centroid_in_world;
  shape.footprint = footprint_of(corners, 0.f);
  if (shape.footprint.size() < 3) shape.footprint = footprint_of(corners, config.point_radius_m);
  return shape;
}

float gap_m(const ObjectShape& a, const ObjectShape& b) {
  // Each of these is at most the true gap (but for the thinning), so the largest is the best.
  float gap = prism_gap_m(a, b);
  if (!b.surface.empty()) gap = std::max(gap, surface_gap_m(b.surface, a));
  if (!a.surface.empty()) gap = std::max(gap, surface_gap_m(a.surface, b));
  return gap;
}

float support_height_m(const ObjectShape& above, const ObjectShape& below, float margin_m) {
  float highest = std::numeric_limits<float>::lowest();
  if (below.surface.empty())
    return distance_m(above.footprint, below.footprint) <= margin_m ? below.top_m : highest;
  for (const Eigen::Vector3f& point : below.surface)
    if (point.z() > highest && point.z() <= above.middle_m() &&
        distance_m(above.footprint, point.head<2>()) <= margin_m)
      highest = point.z();
  return highest;
}

}  // namespace ovimap
