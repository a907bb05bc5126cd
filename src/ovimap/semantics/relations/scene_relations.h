// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "ovimap/semantics/relations/relations.h"

namespace ovimap {

/// "`object` is RELATION `anchor`", as "12 on 3".
struct ObjectRelation {
  InstanceId object = 0;
  Relation relation = Relation::kNear;
  InstanceId anchor = 0;
  float score = 0;       ///< 0.5 on the border to 1
  std::string evidence;  ///< a clause: "0.02 m above the top of #3"
};

/// The relations that hold between pairs of objects: on, inside, above, beside and near. The
/// first of them that holds stands for a pair, so that a mug on a table is not also near it.
/// Directions that depend on who looks are left out, and so is what follows from the reverse
/// (under). `shapes` belong to `ids`; ordered by object, then anchor.
std::vector<ObjectRelation> find_relations(std::span<const InstanceId> ids,
                                           std::span<const ObjectShape> shapes,
                                           const RelationConfig& config = {});

}  // namespace ovimap
