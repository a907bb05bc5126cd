// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "ovimap/map/voxels/label_forest.h"

namespace ovimap {

inline constexpr int kHighestRating = 255;

/// A super-point was seen in a 2D entity.
struct EntitySighting {
  std::uint32_t frame = 0;   ///< counts frames with entities
  std::uint16_t entity = 0;  ///< not 0; means nothing beyond its frame
  std::uint8_t rating = kHighestRating;  ///< of its mask by the mask's source; of an entity always
                                         ///< the same
  /// The highest is given to masks that are true, and to those of which nothing is known.
  bool is_rated() const { return rating < kHighestRating; }
  auto operator<=>(const EntitySighting&) const = default;
};

using EntitySightings = std::map<Label, std::vector<EntitySighting>>;  ///< by root; frames ascend

/// Clusters of these roots (ascending, with sightings) by greedy additive edge contraction (Keuper et
/// al., ICCV 2015). The weight of an edge sums over all pairs with a root in each of two clusters, and
/// over all frames that show both: 1 where one entity shows them, -apart_weight where two do. The pair
/// of most weight, among equals the oldest, becomes one, until no weight is positive. Returns the
/// oldest (lowest) root of each one's cluster.
std::map<Label, Label> contract_edges(std::span<const Label> roots,
                                      const EntitySightings& sightings, double apart_weight);

}  // namespace ovimap
