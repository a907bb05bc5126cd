// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/api/approach_api.h"

#include <nlohmann/json.hpp>

#include "ovimap/base/config.h"
#include "ovimap/server/api/approach_json.h"
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
    const bool whole = is_whole(value, 1e6);  // 3.0 is one as well
    fields.set(name, whole ? std::to_string(value.get<std::int64_t>()) : value.dump());
  }
  return config;
}

std::optional<Eigen::Vector2f> start_of(const json& body) {
  if (!body.contains("from")) return std::nullopt;
  const json& from = body["from"];
  constexpr double kFarthest_m = 1e6;
  const auto fits = [](const json& value) {
    return value.is_number() && std::abs(value.get<double>()) <= kFarthest_m;
  };
  if (!from.is_array() || from.size() != 2 || !fits(from[0]) || !fits(from[1]))
    throw BadRequest(400, "'from' must be two numbers, x and y in metres");
  return Eigen::Vector2f(from[0].get<float>(), from[1].get<float>());
}

}  // namespace

HttpReply answer_approach(const ServedMap& map, const HttpRequest& request) {
  const json body = body_of(request);
  check_keys(body, {"instance", "from", "radius_m", "camera_height_m", "fov_deg", "range_m",
                    "least_seen", "good_share", "poses", "low_m"});
  const auto id = field<InstanceId>(body, "instance");
  if (!id) throw BadRequest(400, "'instance' is missing: the id of an object");
  const ApproachConfig config = config_of(body);
  const auto from = start_of(body);
  const auto now = map.snapshot();
  if (!now->index().find(*id))
    return fault(404, concat("the map has no object ", *id, "; GET /api/instances lists them"));
  std::shared_ptr<const StandingSpace> space;
  try {
    space = map.standing_space();
  } catch (const Error& error) {  // the request is sound, but the map cannot say
    return fault(409, error.what());
  }
  json reply = approach_json(find_approach(*space, *id, config, from), space->grid);
  reply["version"] = now->version;
  reply["instance"] = *id;
  return text_reply(200, "application/json", reply.dump());
}

}  // namespace ovimap
