// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ovimap/track/alignment/normal_equations.h"

namespace ovimap {

/// Where one pose stands from another, and how surely.
struct PoseEdge {
  std::size_t from = 0, to = 0;
  Pose from_to = Pose::Identity();  ///< to's camera in from's
  double sigma_m = 0.01, sigma_rad = 0.01;
  bool loop = false;  ///< may be wrong: its pull is bounded (Cauchy)
};

/// The poses that agree best with all edges, squares weighed; the first stays. Throws nothing:
/// without a better solution the poses are returned as they are.
std::vector<Pose> optimise_poses(const std::vector<Pose>& poses,
                                 const std::vector<PoseEdge>& edges);

/// How far an edge is off its poses, in its standard deviations.
double edge_error(const std::vector<Pose>& poses, const PoseEdge& edge);

}  // namespace ovimap
