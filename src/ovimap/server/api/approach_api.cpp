// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/api/approach_api.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "ovimap/base/config.h"
#include "ovimap/pipeline/approach/approach_json.h"
#include "ovimap/pipeline/search/scene_graph_json.h"
#include "ovimap/server/api/map_json.h"
#include "ovimap/server/http/request_body.h"

namespace ovimap {

namespace {

using nlohmann::json;

ApproachConfig config_of(const json& body) {
  ApproachConfig config;
  ConfigFields fields;
  list_fields(config, fields);
  for (const auto& [name, value] : body.items()) {
    if (name == "instance" || name == "from") continue;
    if (!value.is_number()) throw BadRequest(400, concat("'", name, "' must be a number"));
    fields.set(name, concat(static_cast<float>(value.get<double>())));  // 3.0 and 1e-99 too
  }
  return config;
}

/// Empty: not said. Two numbers: x and y in the grid's frame. Three: a point of the world.
std::vector<float> start_of(const json& body) {
  if (!body.contains("from")) return {};
  const json& from = body["from"];
  constexpr double kFarthest_m = 1e6;
  const auto fits = [](const json& value) {
    return value.is_number() && std::abs(value.get<double>()) <= kFarthest_m;
  };
  const bool listed = from.is_array() && (from.size() == 2 || from.size() == 3);
  if (!listed || !std::all_of(from.begin(), from.end(), fits))
    throw BadRequest(400, "'from' must be two numbers (x and y) or three (a point of the world)");
  return from.get<std::vector<float>>();
}

std::optional<Eigen::Vector2f> in_grid(const std::vector<float>& from, const OccupancyGrid& grid) {
  if (from.empty()) return std::nullopt;
  if (from.size() == 2) return Eigen::Vector2f(from[0], from[1]);
  return (grid.grid_from_world * Eigen::Vector3f(from[0], from[1], from[2])).head<2>();
}

}  // namespace

HttpReply show_rooms(const ServedMap& map) {
  const auto now = map.snapshot();
  const TextEvidence* evidence =
      now->engine && now->engine->matcher() ? now->engine->matcher()->evidence() : nullptr;
  try {
    const SceneGraph graph = make_scene_graph(*map.standing_space(), *now->objects, evidence);
    return text_reply(200, "application/json", scene_graph_json(graph, *now->objects));
  } catch (const Error& error) {  // the map is still being made, or has no surface
    return fault(409, error.what());
  }
}

HttpReply show_gaps(const ServedMap& map) {
  const auto now = map.snapshot();
  json reply = gaps_json(map.gaps());
  reply["version"] = now->version;
  reply["space_known"] = !now->record->seen_free.regions().empty();
  return text_reply(200, "application/json", reply.dump());
}

HttpReply answer_approach(const ServedMap& map, const HttpRequest& request) {
  const json body = body_of(request);
  check_keys(body, {"instance", "from", "radius_m", "camera_height_m", "fov_deg", "range_m",
                    "least_seen", "good_share", "poses", "low_m"});
  const auto given = field<InstanceId>(body, "instance");
  if (!given) throw BadRequest(400, "'instance' is missing: the id of an object");
  const ApproachConfig config = config_of(body);
  const std::vector<float> from = start_of(body);
  const auto now = map.snapshot();
  const InstanceId id = now->index().object(position_of(*now, *given)).id;
  std::shared_ptr<const StandingSpace> space;
  try {
    space = map.standing_space();
  } catch (const Error& error) {  // the request is sound, but the map cannot say
    return fault(409, error.what());
  }
  json reply =
      approach_json(find_approach(*space, id, config, in_grid(from, space->grid)), space->grid);
  reply["version"] = now->version;
  reply["instance"] = id;
  return text_reply(200, "application/json", reply.dump());
}

}  // namespace ovimap
