// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/surface/mesh_extraction.h"

#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "ovimap/map/surface/incremental_mesh.h"
#include "ovimap/map/surface/mesh_welding.h"

namespace ovimap {

void add_normals(Mesh& mesh) {
  mesh.normals.assign(mesh.vertices.size(), Eigen::Vector3f::Zero());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3f twice_area =
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
    for (std::uint32_t vertex : {a, b, c}) mesh.normals[vertex] += twice_area;
  }
  for (Eigen::Vector3f& normal : mesh.normals) normal.normalize();
}

void for_each_mesh_part(const VoxelMap& map, std::size_t triangles,
                        const std::function<void(Mesh&)>& visit) {
  MeshWelder welder;
  const auto finish = [&] {
    Mesh part = welder.take();
    add_normals(part);
    visit(part);
  };
  for_each_patch(map, [&](const Mesh& patch) {
    welder.add(patch);
    if (welder.triangles() >= triangles) finish();
  });
  if (welder.triangles() > 0) finish();
}

Mesh extract_mesh(const VoxelMap& map) {
  Mesh mesh;
  for_each_mesh_part(map, std::numeric_limits<std::size_t>::max(),
                     [&](Mesh& whole) { mesh = std::move(whole); });
  return mesh;
}

}  // namespace ovimap
