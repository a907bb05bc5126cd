// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ovimap/server/served/served_map.h"

namespace ovimap {

// The JSON objects of docs/http-api.md. Lengths are metres in the world frame; numbers that are not
// finite become null.

/// Position of the object that has this id, or had it before it turned out to be part of another.
/// Throws BadRequest (404) where the map has none.
std::size_t position_of(const MapSnapshot& now, InstanceId id);

nlohmann::json map_json(const ServedMap& map);
nlohmann::json instances_json(const ServedMap& map);
/// To which object each label of the surface belongs.
nlohmann::json labels_json(const ServedMap& map);
/// The log, oldest first.
nlohmann::json corrections_json(const ServedMap& map);
/// Of the object at position_of(id), which throws.
nlohmann::json instance_detail_json(const ServedMap& map, InstanceId id);
nlohmann::json answer_json(const MapAnswer& answered);
/// How all objects stand to each other, as find_relations says.
nlohmann::json relations_json(const ServedMap& map);
nlohmann::json mesh_json(const ServedMap& map, int level, std::uint64_t since);
nlohmann::json cameras_json(const ServedMap& map);

}  // namespace ovimap
