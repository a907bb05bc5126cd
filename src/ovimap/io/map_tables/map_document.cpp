// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

Appearance appearance_of(const MapRecord& record, InstanceId id) {
  for (const auto* list : {&record.instances, &record.hidden})
    for (const InstanceSummary& instance : *list)
      if (instance.id == id) return appearance_of(record.semantics.looks, instance.super_points);
  return {};
}

}  // namespace ovimap
