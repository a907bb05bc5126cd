// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/api/neighbors.h"

#include <algorithm>
#include <utility>

namespace ovimap {

namespace {

/// The truest relation from "the object is ON the neighbour" on down; none above a half: near.
Neighbor relate(const QueryScene& scene, std::size_t a, std::size_t b, InstanceId id_b,
                const RelationConfig& config) {
  static constexpr std::pair<Relation, const char*> kTried[] = {{Relation::kOn, "on"},
                                                                {Relation::kInside, "in"},
                                                                {Relation::kUnder, "under"},
                                                                {Relation::kAbove, "above"},
                                                                {Relation::kBeside, "beside"}};
  const std::vector<ObjectShape>& shapes = scene.shapes.whole();
  Neighbor neighbor{id_b, "near", "", gap_m(shapes[a], shapes[b])};
  float best = 0.5f;
  for (const auto& [relation, word] : kTried) {
    RelationRating rating =
        rate_relation(relation, shapes[a], shapes[b], id_b, scene.viewpoint, config);
    if (rating.score <= best) continue;
    best = rating.score;
    neighbor.relation = word;
    neighbor.evidence = std::move(rating.evidence);
  }
  return neighbor;
}

}  // namespace

std::vector<Neighbor> neighbors_of(const SearchIndex& index, const QueryScene& scene,
                                   std::size_t position, const RelationConfig& relations,
                                   std::size_t most) {
  // Boxes are quick, so they say which objects are worth measuring.
  std::vector<std::pair<float, std::size_t>> candidates;
  for (std::size_t i = 0; i < index.size(); ++i) {
    const float gap = index.object(position).box.exteriorDistance(index.object(i).box);
    if (i != position && gap <= relations.near_m) candidates.emplace_back(gap, i);
  }
  std::sort(candidates.begin(), candidates.end());
  candidates.resize(std::min(candidates.size(), 4 * most));
  std::vector<Neighbor> neighbors;
  for (const auto& [gap, i] : candidates) {
    Neighbor neighbor = relate(scene, position, i, index.object(i).id, relations);
    if (neighbor.gap_m <= relations.near_m) neighbors.push_back(std::move(neighbor));
  }
  std::stable_sort(neighbors.begin(), neighbors.end(),
                   [](const Neighbor& a, const Neighbor& b) { return a.gap_m < b.gap_m; });
  if (neighbors.size() > most) neighbors.resize(most);
  return neighbors;
}

}  // namespace ovimap
