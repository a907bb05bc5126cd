// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/thing_sizes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <Eigen/Geometry>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

// Deviations were chosen on generated rooms that are no test (docs/experiments.md).
constexpr float kSmallerDeviation = 0.6f, kLargerDeviation = 0.45f;  // of logarithms
constexpr float kDepthWeight = 0.5f;  // the side away from the camera is seen least
constexpr float kBottomDeviation_m = 0.25f;
constexpr float kMostPenalty = 2.5f;       // of one size in log likelihood: maps merge and cut
constexpr float kMostBottomPenalty = 3.f;  // ... and anything can be put anywhere
constexpr float kThinnest_m = 0.02f;       // below it a size is noise
constexpr float kLeastLogLikelihood = -12.f;
constexpr float kFloorShare = 0.02f;
constexpr float kStrayShare = 0.05f;  // of an object's surface, left out at either end of a side

float log_term(float object_m, float usual_m) {
  const float ratio = std::log(std::max(object_m, kThinnest_m) / std::max(usual_m, kThinnest_m));
  const float deviations = ratio / (ratio < 0.f ? kSmallerDeviation : kLargerDeviation);
  return -std::min(0.5f * deviations * deviations, kMostPenalty);
}

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

}  // namespace

std::vector<ObjectMeasures> measure_objects(std::span<const ObjectShape> shapes) {
  const float floor = floor_height(shapes);
  std::vector<ObjectMeasures> measures;
  for (const ObjectShape& shape : shapes) {
    const Eigen::Vector2f along = long_direction(shape.footprint);
    const Range upright = range_along(shape, Eigen::Vector3f::UnitZ());
    const float length_m = range_along(shape, {along.x(), along.y(), 0.f}).size();
    const float depth_m = range_along(shape, {-along.y(), along.x(), 0.f}).size();
    measures.push_back({upright.size(), std::max(length_m, depth_m), std::min(length_m, depth_m),
                        upright.low - floor});
  }
  return measures;
}

std::vector<ThingSize> read_thing_sizes(const std::vector<std::string>& lines) {
  std::vector<ThingSize> things;
  for (const std::string& line : lines) {
    std::istringstream in(line);
    ThingSize thing;
    std::getline(in, thing.word, ';');
    char separator = ';';
    ObjectMeasures& usual = thing.usual;
    in >> usual.height_m >> separator >> usual.length_m >> separator >> usual.depth_m >>
        separator >> usual.bottom_m >> separator >> thing.highest_bottom_m;
    if (!in || usual.height_m < 0.f || thing.highest_bottom_m < usual.bottom_m)
      throw Error(concat("'", line, "' is no size; give word;height;length;depth;from;to"));
    things.push_back(std::move(thing));
  }
  return things;
}

float size_likelihood(const ObjectMeasures& object, const ThingSize& thing) {
  const ObjectMeasures& usual = thing.usual;
  const float away_m =
      std::max({0.f, usual.bottom_m - object.bottom_m, object.bottom_m - thing.highest_bottom_m}) /
      kBottomDeviation_m;
  // A thing that may be anywhere says less about where it is.
  const float spread = std::log(thing.highest_bottom_m - usual.bottom_m + kBottomDeviation_m);
  const float log_likelihood = log_term(object.height_m, usual.height_m) +
                               log_term(object.length_m, usual.length_m) +
                               kDepthWeight * log_term(object.depth_m, usual.depth_m) -
                               std::min(0.5f * away_m * away_m, kMostBottomPenalty) - spread;
  return std::exp(std::max(log_likelihood, kLeastLogLikelihood));
}

}  // namespace ovimap
