// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scores/box_scores.h"

#include "ovimap/eval/scenes/overlap.h"
#include "ovimap/geometry/box_overlap.h"

namespace ovimap {

namespace {

constexpr int kSharedPercent = 50;
constexpr float kPoor = 0.25f;

}  // namespace

BoxScores& BoxScores::operator+=(const BoxScores& other) {
  things += other.things;
  iou_sum += other.iou_sum;
  under_quarter += other.under_quarter;
  return *this;
}

BoxScores box_scores(std::span<const Eigen::Vector3f> truth_points, const LabelledScene& scene,
                     const std::map<std::uint32_t, Eigen::AlignedBox3f>& boxes) {
  std::map<std::int64_t, Eigen::AlignedBox3f> true_boxes;
  for (std::size_t i = 0; i < truth_points.size(); ++i)
    if (scene.truth[i] > 0) true_boxes[scene.truth[i]].extend(truth_points[i]);
  BoxScores scores;
  const InstanceOverlaps all =
      count_overlaps(scene.truth, scene.predicted, Background::kNotPositive);
  for (const InstanceOverlap& pair : all.overlaps) {
    if (!pair.reaches(kSharedPercent)) continue;
    const auto box = boxes.find(static_cast<std::uint32_t>(all.predicted[pair.predicted].id));
    if (box == boxes.end()) continue;
    const float iou = overlap(box->second, true_boxes.at(all.truth[pair.truth].id));
    ++scores.things;
    scores.iou_sum += static_cast<double>(iou);
    scores.under_quarter += iou < kPoor;
  }
  return scores;
}

}  // namespace ovimap
