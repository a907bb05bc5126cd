// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace ovimap {

/// To a tenth of a millimetre: more digits are noise, and bytes. Null: not finite.
template <class Json = nlohmann::json>
Json rounded_json(double value) {
  constexpr double kSteps = 1e4;
  return std::isfinite(value) ? Json(std::round(value * kSteps) / kSteps) : Json();
}

template <class Json = nlohmann::json, class Value>
Json json_or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}

/// Its numbers so.
template <class Json = nlohmann::json>
Json rounded_point(const Eigen::Vector3f& p) {
  return Json::array(
      {rounded_json<Json>(p.x()), rounded_json<Json>(p.y()), rounded_json<Json>(p.z())});
}

}  // namespace ovimap
