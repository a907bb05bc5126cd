// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "ovimap/instance/instance_registry.h"

namespace ovimap {

/// Ids that were given up, and those that stand for them, which may have been given up since.
using InstanceAliases = std::map<InstanceId, InstanceId>;

/// The id that stands for `id` in the end; itself where it was not given up. `stand_in(id)`: what
/// stands for it now, null where it was not.
template <class StandIn>
InstanceId resolve_alias_by(const StandIn& stand_in, InstanceId id) {
  while (const InstanceId* const next = stand_in(id)) id = *next;
  return id;
}
inline InstanceId resolve_alias(const InstanceAliases& aliases, InstanceId id) {
  const auto stand_in = [&](InstanceId asked) {
    const auto found = aliases.find(asked);
    return found == aliases.end() ? nullptr : &found->second;
  };
  return resolve_alias_by(stand_in, id);
}

}  // namespace ovimap
