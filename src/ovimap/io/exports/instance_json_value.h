// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "ovimap/io/exports/object_titles.h"
#include "ovimap/semantics/relations/scene_relations.h"

namespace ovimap {

/// The number with as few digits as tell the float apart (0.1, not 0.10000000149); null unless
/// finite.
nlohmann::ordered_json json_number(float value);
nlohmann::ordered_json json_vector(const Eigen::Vector3f& v);

/// An instance as every JSON of ours shows it: {"id", "name", "label", "box": {"min", "max"},
/// "centroid", "points", "views", "confidence" where masks are rated, "superpoints"}. For sources
/// that build documents; kept out of other headers, which spares their readers the JSON library.
nlohmann::ordered_json instance_json_value(const InstanceSummary& instance,
                                           const ObjectTitles& titles);

/// Parts of one object, a list of the same without "id": they are called "part 1", ...
nlohmann::ordered_json parts_json_value(std::span<const ObjectPart* const> parts);

/// {"object", "relation", "anchor", "score", "evidence"}
nlohmann::ordered_json relation_json_value(const ObjectRelation& relation);

}  // namespace ovimap
