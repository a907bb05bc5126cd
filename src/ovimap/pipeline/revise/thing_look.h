// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

/// A thing's surface and its colours, to know it again at another place.
struct ThingLook {
  std::vector<Eigen::Vector3f> points;  ///< about their mean, z upwards, metres
  float reach_m = 0;                    ///< root of their mean squared distance from it
  std::array<float, 64> colors{};       ///< shares of 4 x 4 x 4 cells of RGB; all 0: unknown
};

/// `up`: unit, in the world. Points without surface have no colour.
ThingLook thing_look(const MapDocument& map, InstanceId id, const Eigen::Vector3f& up);

/// Mean distance of the two surfaces, laid over each other, turned about the vertical and drawn
/// together until they fit best, as a share of the larger reach. The far fifth of either's points
/// is left out: each was seen from other sides.
float shape_distance(const ThingLook& a, const ThingLook& b);

/// Share that two things' colours have in common, in [0, 1]; 1 where one's are unknown.
float common_colors(const ThingLook& a, const ThingLook& b);

}  // namespace ovimap
