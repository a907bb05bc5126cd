// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ovimap/image/image.h"
#include "ovimap/synth/room.h"
#include "ovimap/synth/trajectory.h"

namespace ovimap {

/// Where on the floor plan a walker may be: the price of each cell, infinite in walls and tall
/// furniture.
class WalkMap {
 public:
  WalkMap(const SynthRoom& room, const TrajectoryConfig& config);

  float cost(const Eigen::Vector2f& point_m) const;
  bool blocked(const Eigen::Vector2f& point_m) const;

  /// The cheapest way between two points, both ends included; just the ends when there is none.
  std::vector<Eigen::Vector2f> way(const Eigen::Vector2f& from_m,
                                   const Eigen::Vector2f& to_m) const;

 private:
  int cell_of(const Eigen::Vector2f& point_m) const;
  Eigen::Vector2f center_of(int cell) const;

  Image<float> costs_;
};

/// `count` points evenly along a closed walk of `laps` laps round the room.
std::vector<Eigen::Vector2f> walk_round(const SynthRoom& room, int laps, int count,
                                        const TrajectoryConfig& config);

}  // namespace ovimap
