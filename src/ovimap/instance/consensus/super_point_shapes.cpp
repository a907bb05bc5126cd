// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/consensus/super_point_shapes.h"

#include <algorithm>

#include "ovimap/map/surface/incremental_mesh.h"
#include "ovimap/map/surface/mesh_extraction.h"

namespace ovimap {

namespace {

Eigen::Vector3d color_of(const Mesh& mesh, std::size_t vertex) {
  const auto& [red, green, blue] = mesh.colors[vertex];
  return {static_cast<double>(red), static_cast<double>(green), static_cast<double>(blue)};
}

SuperPointBorder border_at(const Mesh& mesh, std::size_t from, std::size_t to) {
  const Eigen::Vector3f along = (mesh.vertices[to] - mesh.vertices[from]).normalized();
  return {.edges = 1,
          .fold = (mesh.normals[to] - mesh.normals[from]).dot(along),
          .color_step = (color_of(mesh, to) - color_of(mesh, from)).lpNorm<1>()};
}

}  // namespace

SuperPointShape& SuperPointShape::operator+=(const SuperPointShape& other) {
  vertices += other.vertices;
  position_sum += other.position_sum;
  normal_sum += other.normal_sum;
  color_sum += other.color_sum;
  box.extend(other.box);
  return *this;
}

SuperPointBorder& SuperPointBorder::operator+=(const SuperPointBorder& other) {
  edges += other.edges;
  fold += other.fold;
  color_step += other.color_step;
  return *this;
}

void SuperPointShapes::add(const Mesh& patch) {
  for (std::size_t i = 0; i < patch.vertices.size(); ++i) {
    if (patch.labels[i] == kNoLabel) continue;
    SuperPointShape& shape = of[patch.labels[i]];
    ++shape.vertices;
    shape.position_sum += patch.vertices[i].cast<double>();
    shape.normal_sum += patch.normals[i].cast<double>();
    shape.color_sum += color_of(patch, i);
    shape.box.extend(patch.vertices[i]);
  }
  for (const auto& triangle : patch.triangles)
    for (std::size_t k = 0; k < triangle.size(); ++k) {
      const std::size_t from = triangle[k], to = triangle[(k + 1) % triangle.size()];
      const Label a = patch.labels[from], b = patch.labels[to];
      if (a != b && a != kNoLabel && b != kNoLabel)
        borders[std::minmax(a, b)] += border_at(patch, from, to);
    }
}

SuperPointShapes measure_super_points(const VoxelMap& map) {
  SuperPointShapes shapes;
  for_each_patch(map, [&](Mesh& patch) {
    add_normals(patch);
    shapes.add(patch);
  });
  return shapes;
}

}  // namespace ovimap
