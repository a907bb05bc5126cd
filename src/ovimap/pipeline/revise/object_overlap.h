// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

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

/// Cosine of two objects' embeddings; none when one has none, or they are of different encoders.
std::optional<float> look_similarity(const MapRecord& a, InstanceId id_a, const MapRecord& b,
                                     InstanceId id_b);

/// In [0, 1]: how alike two boxes are in size, whatever way they stand: the smallest ratio of their
/// sorted sides.
float size_similarity(const InstanceSummary& a, const InstanceSummary& b);

}  // namespace ovimap
