// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "ovimap/semantics/query/query_scene.h"
#include "ovimap/semantics/query/search_index.h"
#include "ovimap/semantics/relations/relations.h"

namespace ovimap {

/// An object near another, and what the other is to it.
struct Neighbor {
  InstanceId id = 0;
  std::string relation;  ///< "on", "in", "under", "above", "beside" or "near"
  std::string evidence;  ///< "0.02 m above the top of #12"; empty for "near"
  float gap_m = 0;
};

/// The objects at most `relations.near_m` away, nearest first, at most `most` of them.
std::vector<Neighbor> neighbors_of(const SearchIndex& index, const QueryScene& scene,
                                   std::size_t position, const RelationConfig& relations,
                                   std::size_t most = 8);

}  // namespace ovimap
