// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "ovimap/base/error.h"
#include "ovimap/server/http/http_message.h"

namespace ovimap {

/// The request itself is wrong; its text becomes a reply of that status.
struct BadRequest : std::runtime_error {
  BadRequest(int code, const std::string& sentence) : std::runtime_error(sentence), status(code) {}
  int status;
};

/// The JSON object in a request's body. Throws BadRequest where there is none.
nlohmann::json body_of(const HttpRequest& request);

/// The JSON object in `text`, which `name` names in faults. Throws BadRequest where there is none.
nlohmann::json object_of(std::string_view text, const std::string& name);

/// Throws BadRequest for a field that is not known.
void check_keys(const nlohmann::json& body, std::initializer_list<const char*> known);

/// Whether JSON counts it as a whole number in [0, most]: 12.0 is one as well.
bool is_whole(const nlohmann::json& value, double most);

/// Field `name` of a body. Throws BadRequest when its type is another.
template <class Value>
std::optional<Value> field(const nlohmann::json& body, const char* name) {
  if (!body.contains(name)) return std::nullopt;
  const nlohmann::json& value = body[name];
  bool fits = value.is_string();
  if constexpr (std::is_same_v<Value, bool>)
    fits = value.is_boolean();
  else if constexpr (std::is_integral_v<Value>)
    fits = is_whole(value, static_cast<double>(std::numeric_limits<std::uint32_t>::max()));
  if (!fits)
    throw BadRequest(400, concat("'", name, "' is of the wrong type; see /api/openapi.json"));
  return value.get<Value>();
}

/// Likewise a list, of texts (at most so many; none where the field is missing) or of whole numbers
/// (at least one).
std::vector<std::string> texts_field(const nlohmann::json& body, const char* name,
                                     std::size_t most);
template <class Number>
std::vector<Number> numbers_field(const nlohmann::json& body, const char* name) {
  const auto fits = [](const nlohmann::json& item) {
    return is_whole(item, static_cast<double>(std::numeric_limits<Number>::max()));
  };
  const bool given = body.contains(name) && body[name].is_array() && !body[name].empty();
  if (!given || !std::all_of(body[name].begin(), body[name].end(), fits))
    throw BadRequest(400, concat("'", name, "' must be a list of whole numbers"));
  return body[name].get<std::vector<Number>>();
}

}  // namespace ovimap
