// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/request_body.h"

#include <cmath>

#include "ovimap/base/bounded_json.h"

namespace ovimap {

using nlohmann::json;

json body_of(const HttpRequest& request) {
  if (!request.header("content-type").starts_with("application/json"))
    throw BadRequest(415, "send the body as Content-Type: application/json");
  return object_of(request.body, "the body");
}

json object_of(std::string_view text, const std::string& name) {
  try {
    json object = parse_json(text, name, kSmallDocument);
    if (object.is_object()) return object;
  } catch (const Error& fault) {
    throw BadRequest(400, concat(fault.what(), "; see /api/openapi.json"));
  }
  throw BadRequest(400, name + " must be a JSON object");
}

void check_keys(const json& body, std::initializer_list<const char*> known) {
  for (const auto& [key, value] : body.items())
    if (std::find(known.begin(), known.end(), key) == known.end())
      throw BadRequest(400,
                       concat("'", key, "' is no field of this request; see /api/openapi.json"));
}

bool is_whole(const json& value, double most) {
  if (!value.is_number()) return false;
  const double number = value.get<double>();
  return number >= 0 && number <= most && number == std::floor(number);
}

std::vector<std::string> texts_field(const json& body, const char* name, std::size_t most) {
  if (!body.contains(name)) return {};
  const json& list = body[name];
  if (!list.is_array() ||
      !std::all_of(list.begin(), list.end(), [](const json& item) { return item.is_string(); }))
    throw BadRequest(400, concat("'", name, "' must be a list of texts"));
  if (list.size() > most)
    throw BadRequest(400, concat("'", name, "' has more than ", most, " entries"));
  return list.get<std::vector<std::string>>();
}

}  // namespace ovimap
