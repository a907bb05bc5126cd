// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/geometry/geometry_scores.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/eval/geometry/nearest.h"
#include "ovimap/eval/geometry/surface_distance.h"

namespace ovimap {

namespace {

constexpr std::size_t kPointsPerTask = 512;

/// Distances of the points that are within the limit, in their order.
std::vector<float> distances_within(const SurfaceDistance& surface,
                                    std::span<const Eigen::Vector3f> points, float limit_m) {
  std::vector<std::optional<float>> all(points.size());
  parallel_for(points.size(), kPointsPerTask,
               [&](std::size_t i) { all[i] = surface.find(points[i], limit_m); });
  std::vector<float> within;
  for (const std::optional<float>& distance : all)
    if (distance) within.push_back(*distance);
  return within;
}

double share(std::size_t part, std::size_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

void list_fields(GeometryScoresConfig& config, ConfigFields& fields) {
  fields.add(
      "accuracy_limit_m", config.accuracy_limit_m, 0.001f, 10.f,
      "predicted vertices farther from the truth are stray and leave the accuracy, in metres");
  fields.add("completeness_m", config.completeness_m, 0.001f, 1.f,
             "how near a predicted vertex makes a truth vertex covered, in metres");
  fields.add("fine_completeness_m", config.fine_completeness_m, 0.001f, 1.f,
             "how near the predicted surface makes a truth vertex covered finely, in metres");
}

GeometryScores geometry_scores(const Mesh& truth, const Mesh& predicted,
                               const GeometryScoresConfig& config) {
  GeometryScores scores;
  scores.accuracy_m = scores.accuracy_median_m = config.accuracy_limit_m;
  if (truth.vertices.empty() || predicted.vertices.empty()) return scores;
  std::vector<float> distances_m =
      distances_within(SurfaceDistance(truth), predicted.vertices, config.accuracy_limit_m);
  scores.stray = 1 - share(distances_m.size(), predicted.vertices.size());
  if (!distances_m.empty()) {
    scores.accuracy_m = std::accumulate(distances_m.begin(), distances_m.end(), 0.0) /
                        static_cast<double>(distances_m.size());
    const auto middle =
        distances_m.begin() + static_cast<std::ptrdiff_t>((distances_m.size() - 1) / 2);
    std::nth_element(distances_m.begin(), middle, distances_m.end());
    scores.accuracy_median_m = *middle;
  }
  const auto near =
      NearestPoints(predicted.vertices).find_all(truth.vertices, config.completeness_m);
  const auto covered =
      std::count_if(near.begin(), near.end(), [](const auto& n) { return n.has_value(); });
  scores.completeness = share(static_cast<std::size_t>(covered), truth.vertices.size());
  scores.fine_completeness =
      share(distances_within(SurfaceDistance(predicted), truth.vertices, config.fine_completeness_m)
                .size(),
            truth.vertices.size());
  return scores;
}

}  // namespace ovimap
