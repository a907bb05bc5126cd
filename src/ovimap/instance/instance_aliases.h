// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "ovimap/instance/instance_registry.h"

namespace ovimap {

/// Ids that were given up, and those that stand for them, which may have been given up since.
using InstanceAliases = std::map<InstanceId, InstanceId>;

/// The id that stands for `id` in the end; itself where it was not given up.
inline InstanceId resolve_alias(const InstanceAliases& aliases, InstanceId id) {
  for (auto found = aliases.find(id); found != aliases.end(); found = aliases.find(id))
    id = found->second;
  return id;
}

}  // namespace ovimap
