// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scores/size_recall.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "ovimap/base/config.h"
#include "ovimap/eval/scenes/overlap.h"

namespace ovimap {

namespace {

constexpr int kTurns = 18;  // of the box, over a right angle
constexpr int kFoundPercent = 50;

MeasuredSize size_of(const std::vector<Eigen::Vector3f>& points) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::array<float, 3> best{};
  float least = kInfinity;
  for (int turn = 0; turn < kTurns; ++turn) {
    const float angle = 0.5f * std::numbers::pi_v<float> * static_cast<float>(turn) / kTurns;
    const float c = std::cos(angle), s = std::sin(angle);
    Eigen::Vector3f low = Eigen::Vector3f::Constant(kInfinity), high = -low;
    for (const Eigen::Vector3f& p : points) {
      const Eigen::Vector3f turned(c * p.x() + s * p.y(), c * p.y() - s * p.x(), p.z());
      low = low.cwiseMin(turned), high = high.cwiseMax(turned);
    }
    const Eigen::Vector3f sides = high - low;
    if (sides.x() * sides.y() >= least) continue;
    least = sides.x() * sides.y();
    best = {sides.x(), sides.y(), sides.z()};
  }
  std::sort(best.begin(), best.end());
  constexpr float kLitres_m3 = 1000;
  return {kLitres_m3 * best[0] * best[1] * best[2], best[0], best[1]};
}

std::set<std::int32_t> found_in(const InstanceOverlaps& table) {
  std::set<std::int32_t> found;
  for (const InstanceOverlap& overlap : table.overlaps)
    if (overlap.reaches(kFoundPercent))
      found.insert(static_cast<std::int32_t>(table.truth[overlap.truth].id));
  return found;
}

void count(RecallGroup& group, bool found) {
  ++group.things;
  group.found += found ? 1 : 0;
}

}  // namespace

std::map<std::int32_t, MeasuredSize> measured_sizes(std::span<const Eigen::Vector3f> points,
                                                    std::span<const std::int32_t> labels) {
  std::map<std::int32_t, std::vector<Eigen::Vector3f>> points_of;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (labels[i] > 0) points_of[labels[i]].push_back(points[i]);
  std::map<std::int32_t, MeasuredSize> sizes;
  for (const auto& [id, own] : points_of) sizes[id] = size_of(own);
  return sizes;
}

void list_fields(SizeGroupsConfig& config, ConfigFields& fields) {
  fields.add("small_litres", config.small_litres, 0.f, 1e6f,
             "things whose box holds less are small, litres");
  fields.add("medium_litres", config.medium_litres, 0.f, 1e6f,
             "things whose box holds less are of medium size, litres");
  fields.add("flat_thickness_m", config.flat_thickness_m, 0.f, 1.f,
             "flat things are no thicker, metres");
  fields.add("flat_breadth_ratio", config.flat_breadth_ratio, 1.f, 100.f,
             "and at least so many times as broad");
}

SizeRecall recall_by_size(std::span<const SizedScene> scenes, const SizeGroupsConfig& config) {
  SizeRecall recall{{"small"}, {"medium"}, {"large"}, {"flat"}, {"not scored"}};
  std::size_t predicted = 0, truth = 0;
  for (const SizedScene& scene : scenes) {
    const InstanceOverlaps table =
        count_overlaps(scene.truth, scene.predicted, Background::kNotPositive);
    const std::set<std::int32_t> found = found_in(table);
    predicted += table.predicted.size(), truth += table.truth.size();
    for (const auto& [id, size] : scene.sizes) {
      const bool is_found = found.count(id) > 0;
      if (scene.structure.count(id) > 0) continue;
      if (scene.unscored.count(id) > 0) {
        count(recall.unscored, is_found);
        continue;
      }
      count(size.litres < config.small_litres    ? recall.small
            : size.litres < config.medium_litres ? recall.medium
                                                 : recall.large,
            is_found);
      if (size.thickness_m <= config.flat_thickness_m &&
          size.breadth_m >= config.flat_breadth_ratio * size.thickness_m)
        count(recall.flat, is_found);
    }
  }
  if (truth > 0)
    recall.objects_per_thing = static_cast<double>(predicted) / static_cast<double>(truth);
  return recall;
}

}  // namespace ovimap
