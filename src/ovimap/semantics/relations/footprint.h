// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ovimap/geometry/convex_hull.h"

namespace ovimap {

/// A convex polygon in the ground plane, metres, counter-clockwise, at least three corners.
using Footprint = std::vector<Eigen::Vector2f>;

float area_m2(const Footprint& footprint);
float perimeter_m(const Footprint& footprint);

/// Smallest distance between two parallel lines that hold it between them.
float smallest_width_m(const Footprint& footprint);

/// Area of what two footprints share.
float overlap_m2(const Footprint& a, const Footprint& b);

/// The point of the footprint, inside included, that is nearest to `point`.
Eigen::Vector2f nearest_point(const Footprint& footprint, const Eigen::Vector2f& point);

/// 0 where they touch or overlap.
float distance_m(const Footprint& footprint, const Eigen::Vector2f& point);
float distance_m(const Footprint& a, const Footprint& b);

}  // namespace ovimap
