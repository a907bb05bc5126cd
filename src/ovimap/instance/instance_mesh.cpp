// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/instance_mesh.h"

#include "ovimap/map/mesh_extraction.h"

namespace ovimap {

Mesh extract_instance_mesh(const VoxelMap& map, std::span<const InstanceSummary> instances) {
  std::vector<InstanceId> instance_of(map.labels().roots().size(), 0);
  for (const InstanceSummary& instance : instances)
    for (Label root : instance.super_points) instance_of[root] = instance.id;
  Mesh mesh = extract_mesh(map);
  for (std::uint32_t& label : mesh.labels) label = instance_of[label];
  return mesh;
}

}  // namespace ovimap
