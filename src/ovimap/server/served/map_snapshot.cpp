// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/served/map_snapshot.h"

namespace ovimap {

const char* search_state_name(SearchState state) {
  switch (state) {
    case SearchState::kPreparing:
      return "preparing";
    case SearchState::kReady:
      return "ready";
    default:
      return "unavailable";
  }
}

std::string MapSnapshot::name_of(InstanceId id) const {
  const auto found = record->names.find(id);
  return found == record->names.end() ? "" : found->second;
}

std::set<InstanceId> MapSnapshot::hidden() const {
  std::set<InstanceId> ids;
  for (const InstanceSummary& instance : record->hidden) ids.insert(instance.id);
  return ids;
}

InstanceId MapSnapshot::current_id(InstanceId id) const {
  return resolve_alias(aliases, id);
}

bool MapSnapshot::knows(InstanceId id) const {
  return index().find(id).has_value() || hidden().contains(id);
}

}  // namespace ovimap
