// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/instance_mesh.h"

#include <algorithm>
#include <tuple>

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

InstanceSurfaces sample_surfaces(const Mesh& mesh, float spacing_m) {
  using Place = std::tuple<InstanceId, int, int, int>;
  std::vector<std::pair<Place, std::size_t>> places;
  for (std::size_t i = 0; i < mesh.labels.size(); ++i) {
    if (mesh.labels[i] == 0) continue;
    const Eigen::Vector3i cell = (mesh.vertices[i] / spacing_m).array().floor().cast<int>();
    places.emplace_back(Place{mesh.labels[i], cell.x(), cell.y(), cell.z()}, i);
  }
  std::sort(places.begin(), places.end());
  const auto last = std::unique(places.begin(), places.end(),
                                [](const auto& a, const auto& b) { return a.first == b.first; });
  std::sort(places.begin(), last, [](const auto& a, const auto& b) { return a.second < b.second; });
  InstanceSurfaces surfaces;
  for (auto place = places.begin(); place != last; ++place)
    surfaces[std::get<0>(place->first)].push_back(mesh.vertices[place->second]);
  return surfaces;
}

}  // namespace ovimap
