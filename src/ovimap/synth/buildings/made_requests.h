// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ovimap/synth/rooms/room_spec.h"

namespace ovimap {

using Names = std::vector<std::string>;

/// Furniture that is made by rule: a `kind` of made_kinds, of a class called otherwise.
inline FurnitureRequest made(const std::string& class_name, const std::string& kind,
                             Placement placement, int count = 1, const Names& at = {},
                             std::optional<float> bottom_m = {}) {
  return {class_name, placement, count, at, made_id(kind), bottom_m};
}
/// ... of a class that is called as the kind is.
inline FurnitureRequest made(const std::string& kind, Placement placement, int count = 1,
                             const Names& at = {}, std::optional<float> bottom_m = {}) {
  return made(kind, kind, placement, count, at, bottom_m);
}

inline Names all_made(const Names& kinds) {
  Names ids;
  for (const std::string& kind : kinds) ids.push_back(made_id(kind));
  return ids;
}

}  // namespace ovimap
