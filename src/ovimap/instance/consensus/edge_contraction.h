// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "ovimap/map/voxels/label_forest.h"

namespace ovimap {

inline constexpr int kHighestRating = 255;

/// A super-point was seen in a 2D entity.
struct EntitySighting {
  std::uint32_t frame = 0;               ///< counts frames with entities
  std::uint16_t entity = 0;              ///< not 0; means nothing beyond its frame
  std::uint8_t rating = kHighestRating;  ///< of its mask by the mask's source; of an entity always
                                         ///< the same
  /// The highest is given to masks that are true, and to those of which nothing is known.
  bool is_rated() const { return rating < kHighestRating; }
  auto operator<=>(const EntitySighting&) const = default;
};

using EntitySightings = std::map<Label, std::vector<EntitySighting>>;  ///< by root; frames ascend

/// How many of some super-points an entity shows.
struct Presence {
  EntitySighting sighting;
  int count = 0;
};
using Presences = std::vector<Presence>;  ///< each sighting once, ascending

using Node = std::uint32_t;  ///< place of some super-points among all that are contracted

/// Clusters of nodes, each a super-point or some that stay together, by greedy additive edge
/// contraction (Keuper et al., ICCV 2015). The weight of an edge sums over all pairs with a
/// super-point in each of two clusters, and over all frames that show both: 1 where one entity
/// shows them, -apart_weight where two do. The pair of most weight, among equals the oldest
/// (lowest), becomes one, until no weight is positive. `tied`: pairs that become one unless
/// something speaks against it. Returns the oldest node of each one's cluster.
std::vector<Node> contract_nodes(std::vector<Presences> nodes,
                                 std::span<const std::pair<Node, Node>> tied, double apart_weight);

/// The same of these roots (ascending, with sightings): the oldest (lowest) root of each one's
/// cluster.
std::map<Label, Label> contract_edges(std::span<const Label> roots,
                                      const EntitySightings& sightings, double apart_weight);

}  // namespace ovimap
