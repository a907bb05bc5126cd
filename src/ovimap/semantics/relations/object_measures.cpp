// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/relations/object_measures.h"

#include <algorithm>
#include <cstdint>

#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

constexpr float kColumn_m = 0.04f;  // of surface that may lie above other surface
constexpr float kFloorShare = 0.02f;
constexpr float kStrayShare = 0.05f;  // of an object's surface, left out at either end of a side

float quantile_in_place(std::vector<float>& values, float share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<float>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

float floor_height(std::span<const ObjectShape> shapes) {
  std::vector<float> heights;
  for (const ObjectShape& shape : shapes) {
    for (const Eigen::Vector3f& point : shape.surface) heights.push_back(point.z());
    if (shape.surface.empty()) heights.insert(heights.end(), {shape.bottom_m, shape.top_m});
  }
  return heights.empty() ? 0.f : quantile_in_place(heights, kFloorShare);
}

/// Direction of the longer side of the smallest rectangle around a footprint.
Eigen::Vector2f long_direction(const Footprint& footprint) {
  const PlaneRectangle rectangle = smallest_rectangle(footprint);
  return rectangle.sides.x() >= rectangle.sides.y() ? rectangle.along : rectangle.across();
}

struct Range {
  float low = 0, high = 0;
  float size() const { return high - low; }
};

/// Of a shape along a direction: of its surface without what strays, or of its prism.
Range range_along(const ObjectShape& shape, const Eigen::Vector3f& direction) {
  std::vector<float> places;
  for (const Eigen::Vector3f& point : shape.surface) places.push_back(direction.dot(point));
  const bool known = !places.empty();
  if (!known)
    for (const Eigen::Vector2f& corner : shape.footprint)
      for (const float height : {shape.bottom_m, shape.top_m})
        places.push_back(direction.dot(Eigen::Vector3f(corner.x(), corner.y(), height)));
  const float stray = known ? kStrayShare : 0.f;
  return {quantile_in_place(places, stray), quantile_in_place(places, 1.f - stray)};
}

/// A point of a surface in the upright column that it lies in.
struct ColumnPoint {
  std::uint64_t column = 0;
  float height_m = 0;
};

/// By column.
std::vector<ColumnPoint> in_columns(const std::vector<Eigen::Vector3f>& surface) {
  std::vector<ColumnPoint> points;
  points.reserve(surface.size());
  for (const Eigen::Vector3f& point : surface) {
    const Eigen::Vector2i cell = (point.head<2>() / kColumn_m).array().floor().cast<int>();
    points.push_back({std::uint64_t{static_cast<std::uint32_t>(cell.x())} << 32 |
                          static_cast<std::uint32_t>(cell.y()),
                      point.z()});
  }
  std::sort(points.begin(), points.end(),
            [](const ColumnPoint& a, const ColumnPoint& b) { return a.column < b.column; });
  return points;
}

/// `top_m`: of the surface, in its frame.
void measure_spread(const std::vector<Eigen::Vector3f>& surface, float top_m,
                    ObjectMeasures& measures) {
  const std::vector<ColumnPoint> points = in_columns(surface);
  int at_top = 0, covered = 0;
  for (auto begin = points.begin(); begin != points.end();) {
    const auto end = std::find_if(begin, points.end(), [&](const ColumnPoint& point) {
      return point.column != begin->column;
    });
    float highest = begin->height_m;
    for (auto point = begin; point != end; ++point) highest = std::max(highest, point->height_m);
    for (; begin != end; ++begin) {
      at_top += begin->height_m > top_m - kSurfaceStep_m;
      covered += begin->height_m < highest - kSurfaceStep_m;
    }
  }
  const auto count = static_cast<float>(points.size());
  measures.top_share = static_cast<float>(at_top) / count;
  measures.covered_share = static_cast<float>(covered) / count;
}

/// `floor_m`: its height.
ObjectMeasures measure_object(const ObjectShape& shape, float floor_m) {
  const Eigen::Vector2f along = long_direction(shape.footprint);
  const Range upright = range_along(shape, Eigen::Vector3f::UnitZ());
  const float length_m = range_along(shape, {along.x(), along.y(), 0.f}).size();
  const float depth_m = range_along(shape, {-along.y(), along.x(), 0.f}).size();
  ObjectMeasures measures{upright.size(), std::max(length_m, depth_m), std::min(length_m, depth_m),
                          upright.low - floor_m};
  if (!shape.surface.empty()) measure_spread(shape.surface, upright.high, measures);
  return measures;
}

}  // namespace

std::vector<ObjectMeasures> measure_objects(std::span<const ObjectShape> shapes) {
  constexpr std::size_t kShapesPerTask = 8;
  const float floor_m = floor_height(shapes);
  std::vector<ObjectMeasures> measures(shapes.size());
  parallel_for_ranges(shapes.size(), kShapesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) measures[i] = measure_object(shapes[i], floor_m);
  });
  return measures;
}

}  // namespace ovimap
