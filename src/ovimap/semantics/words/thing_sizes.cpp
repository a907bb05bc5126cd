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
constexpr float kDepthWeight = 0.5f;      // the side away from the camera is seen least
constexpr float kBottomDeviation_m = 0.25f;
constexpr float kMostBottomPenalty = 3.f;  // in log likelihood: anything can be put anywhere
constexpr float kThinnest_m = 0.02f;       // below it a size is noise
constexpr float kLeastLogLikelihood = -12.f;
constexpr float kFloorShare = 0.02f;

float log_term(float object_m, float usual_m) {
  const float ratio = std::log(std::max(object_m, kThinnest_m) / std::max(usual_m, kThinnest_m));
  const float deviations = ratio / (ratio < 0.f ? kSmallerDeviation : kLargerDeviation);
  return -0.5f * deviations * deviations;
}

float floor_height(std::span<const ObjectShape> shapes) {
  std::vector<float> heights;
  for (const ObjectShape& shape : shapes) {
    for (const Eigen::Vector3f& point : shape.surface) heights.push_back(point.z());
    if (shape.surface.empty()) heights.insert(heights.end(), {shape.bottom_m, shape.top_m});
  }
  if (heights.empty()) return 0.f;
  const auto at = heights.begin() + static_cast<std::ptrdiff_t>(
                                        kFloorShare * static_cast<float>(heights.size() - 1));
  std::nth_element(heights.begin(), at, heights.end());
  return *at;
}

/// The sides, longer first, of the smallest rectangle around a convex footprint; one of them lies
/// along an edge of it.
std::pair<float, float> smallest_rectangle(const Footprint& footprint) {
  std::pair<float, float> best{0.f, 0.f};
  float area = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < footprint.size(); ++i) {
    const Eigen::Vector2f edge = footprint[(i + 1) % footprint.size()] - footprint[i];
    if (edge.isZero()) continue;
    const Eigen::Vector2f along = edge.normalized(), across(-along.y(), along.x());
    Eigen::AlignedBox2f box;
    for (const Eigen::Vector2f& corner : footprint)
      box.extend(Eigen::Vector2f(along.dot(corner), across.dot(corner)));
    const Eigen::Vector2f sides = box.sizes();
    if (sides.prod() >= area) continue;
    area = sides.prod();
    best = {sides.maxCoeff(), sides.minCoeff()};
  }
  return best;
}

}  // namespace

std::vector<ObjectMeasures> measure_objects(std::span<const ObjectShape> shapes) {
  const float floor = floor_height(shapes);
  std::vector<ObjectMeasures> measures;
  for (const ObjectShape& shape : shapes) {
    const auto [length, depth] = smallest_rectangle(shape.footprint);
    measures.push_back({shape.height_m(), length, depth, shape.bottom_m - floor});
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
  const float away_m = std::max({0.f, usual.bottom_m - object.bottom_m,
                                 object.bottom_m - thing.highest_bottom_m}) /
                       kBottomDeviation_m;
  // A thing that may be anywhere says less about where it is.
  const float spread = std::log(thing.highest_bottom_m - usual.bottom_m + kBottomDeviation_m);
  const float log_likelihood =
      log_term(object.height_m, usual.height_m) + log_term(object.length_m, usual.length_m) +
      kDepthWeight * log_term(object.depth_m, usual.depth_m) -
      std::min(0.5f * away_m * away_m, kMostBottomPenalty) - spread;
  return std::exp(std::max(log_likelihood, kLeastLogLikelihood));
}

}  // namespace ovimap
