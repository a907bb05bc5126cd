// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/mesh/map_mesh.h"

#include "ovimap/io/mesh/mesh_pieces.h"

namespace ovimap {

Mesh visible_mesh(const MapDocument& document) {
  if (document.hidden.empty()) return extract_instance_mesh(document.map, document.instances);
  std::vector<InstanceSummary> all = document.instances;
  std::set<InstanceId> hidden;
  for (const InstanceSummary& instance : document.hidden) {
    all.push_back(instance);
    hidden.insert(instance.id);
  }
  return without_labels(extract_instance_mesh(document.map, all),
                        [&](std::uint32_t label) { return hidden.contains(label); });
}

}  // namespace ovimap
