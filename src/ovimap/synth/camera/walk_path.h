// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "ovimap/image/image.h"
#include "ovimap/synth/camera/trajectory.h"
#include "ovimap/synth/rooms/room.h"

namespace ovimap {

/// Where on the floor plan a walker may be: the price of each cell, infinite in walls and tall
/// furniture.
class WalkMap {
 public:
  WalkMap(const SynthRoom& room, const TrajectoryConfig& config);

  float cost(const Eigen::Vector2f& point_m) const;
  bool blocked(const Eigen::Vector2f& point_m) const;

  /// The middle of the free cell nearest to `point_m` in the largest area that hangs together;
  /// nothing where all is blocked.
  [[nodiscard]] std::optional<Eigen::Vector2f> nearest_free(const Eigen::Vector2f& point_m) const;

  /// The cheapest way between two points, both ends included; just the ends when there is none.
  std::vector<Eigen::Vector2f> way(const Eigen::Vector2f& from_m,
                                   const Eigen::Vector2f& to_m) const;

 private:
  int cell_of(const Eigen::Vector2f& point_m) const;
  Eigen::Vector2f center_of(int cell) const;

  /// Calls visit(cell, distance_m) for the cells less than `reach_m` outside the box.
  template <class Visit>
  void for_each_cell_near(const OrientedBox& box, float reach_m, const Visit& visit);
  void find_largest_area();

  Image<float> costs_;
  std::vector<int> area_;  ///< cells of the largest area that is not blocked
};

/// A closed way through `corners` and back to the first: the cheapest, its bends rounded, as points
/// `spacing_m` apart (a little less, so that they come out even). Empty where it has no length.
std::vector<Eigen::Vector2f> even_loop(const WalkMap& map,
                                       const std::vector<Eigen::Vector2f>& corners,
                                       float spacing_m);

/// `count` points evenly along a closed walk of `laps` laps round the room.
std::vector<Eigen::Vector2f> walk_round(const SynthRoom& room, int laps, int count,
                                        const TrajectoryConfig& config);

}  // namespace ovimap
