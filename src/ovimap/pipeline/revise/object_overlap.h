// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

/// How much of two objects' surfaces lies at the same place.
struct ObjectOverlap {
  float share_a = 0, share_b = 0;  ///< of each one's points
  float shared_points = 0;         ///< the mean of the two counts
  float iou = 0;                   ///< shared points over all points
  float common_iou = 0;  ///< the same, of the points where both maps have objects' surface
};

/// The overlaps of all pairs of objects that share some surface, by (id in a, id in b). Surfaces
/// are those of the corrected maps, `b` moved by a_from_b; points nearer than `tolerance_m` to a
/// point of the other are shared.
using ObjectOverlaps = std::map<std::pair<InstanceId, InstanceId>, ObjectOverlap>;
ObjectOverlaps overlaps(const MapRecord& a, const MapRecord& b, const Pose& a_from_b,
                        float tolerance_m);

}  // namespace ovimap
