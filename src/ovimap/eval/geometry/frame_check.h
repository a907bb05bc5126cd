// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <Eigen/Core>

namespace ovimap {

class ConfigFields;

struct FrameCheckConfig {
  float radius_m = 0.05f;     ///< how near a point of the truth must be
  float good_share = 0.5f;    ///< share of the map near the truth that needs no explanation
  float least_share = 0.02f;  ///< a map with less of it near the truth, and the truth likewise near
                              ///< the map, does not belong to it
  float better_ratio = 2.f;   ///< how many times the share another reading must explain
  int samples = 1000;         ///< points of either side that are looked at, evenly spread
};
void list_fields(FrameCheckConfig& config, ConfigFields& fields);

/// How a map lies to its truth.
struct FrameCheck {
  double share = 0;   ///< of the map's points that have truth near, as the two are
  std::string fault;  ///< empty: they fit. Else what is wrong and how to mend it, in one clause
};

/// Tells whether a map and the truth are in the same frame and scale by how much of the map has
/// truth near. Where that is little it tries other units (powers of ten), other axes and another
/// origin, and names the simplest that fits; a map that is merely incomplete or bad passes. Neither
/// side may be empty.
FrameCheck check_frames(std::span<const Eigen::Vector3f> truth,
                        std::span<const Eigen::Vector3f> predicted,
                        const FrameCheckConfig& config = {});

}  // namespace ovimap
