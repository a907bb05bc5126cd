// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/eval/scenes/labelled_scene.h"

namespace ovimap {

/// How well the boxes of objects hold the things that they are.
struct BoxScores {
  int things = 0;         ///< true ones that an object shares half of its vertices with (IoU)
  double iou_sum = 0;     ///< of both boxes, over those
  int under_quarter = 0;  ///< of those, boxes that overlap by less than a quarter

  double mean_iou() const { return things == 0 ? 0. : iou_sum / things; }
  BoxScores& operator+=(const BoxScores& other);
};

/// `truth_points`: the vertices that the scene labels; a thing's box is around all of its own.
/// `boxes`: of predicted instances, by id; what has none there is left out.
BoxScores box_scores(std::span<const Eigen::Vector3f> truth_points, const LabelledScene& scene,
                     const std::map<std::uint32_t, Eigen::AlignedBox3f>& boxes);

}  // namespace ovimap
