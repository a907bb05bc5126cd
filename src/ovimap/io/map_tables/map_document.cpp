// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_tables/map_document.h"

#include <algorithm>

namespace ovimap {

InstanceId last_instance(const MapRecord& record) {
  InstanceId last = record.registry.last_id;
  for (const MapEdit& edit : record.edits) last = std::max(last, edit.new_instance);
  return last;
}

Appearance appearance_of(const MapRecord& record, InstanceId id) {
  for (const auto* list : {&record.instances, &record.hidden})
    if (const InstanceSummary* found = find_instance(*list, id))
      return appearance_of(record.semantics.looks, found->super_points);
  return {};
}

}  // namespace ovimap
