// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/surface/mesh_chunks.h"

#include <algorithm>

#include <meshoptimizer.h>

namespace ovimap {

namespace {

/// Appends `from`'s vertex to `to`; attributes that `from` lacks stay out.
void copy_vertex(const Mesh& from, std::uint32_t vertex, Mesh& to) {
  to.vertices.push_back(from.vertices[vertex]);
  if (!from.normals.empty()) to.normals.push_back(from.normals[vertex]);
  if (!from.colors.empty()) to.colors.push_back(from.colors[vertex]);
  if (!from.labels.empty()) to.labels.push_back(from.labels[vertex]);
}

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Those triangles, with the vertices they need.
Mesh with_triangles(const Mesh& mesh, const Triangles& triangles) {
  constexpr std::uint32_t kUnused = ~std::uint32_t{0};
  Mesh part;
  std::vector<std::uint32_t> place(mesh.vertices.size(), kUnused);
  for (const auto& corners : triangles) {
    auto& own = part.triangles.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      std::uint32_t& vertex = place[corners[c]];
      if (vertex == kUnused) {
        vertex = static_cast<std::uint32_t>(part.vertices.size());
        copy_vertex(mesh, corners[c], part);
      }
      own[c] = vertex;
    }
  }
  return part;
}

}  // namespace

ChunkTotals totals_of(const MeshChunk& chunk, std::uint64_t since) {
  ChunkTotals totals;
  for (const SurfacePatch& patch : chunk.patches) {
    if (patch.version <= since) continue;
    ++totals.patches;
    totals.vertices += static_cast<std::uint32_t>(patch.mesh->vertices.size());
    totals.triangles += static_cast<std::uint32_t>(patch.mesh->triangles.size());
  }
  return totals;
}

Mesh in_less_detail(const Mesh& mesh, const LevelOfDetail& level, float voxel_size_m) {
  if (mesh.triangles.empty()) return {};
  const std::size_t indices = mesh.triangles.size() * 3;
  const float* positions = mesh.vertices.front().data();
  constexpr std::size_t kStride = sizeof(Eigen::Vector3f);
  const float scale = meshopt_simplifyScale(positions, mesh.vertices.size(), kStride);
  Triangles kept(mesh.triangles.size());
  const auto target = static_cast<std::size_t>(static_cast<float>(indices) * level.triangle_share);
  const std::size_t left = meshopt_simplify(
      kept.front().data(), mesh.triangles.front().data(), indices, positions, mesh.vertices.size(),
      kStride, target, level.max_error_voxels * voxel_size_m / std::max(scale, 1e-6f),
      level.borders_stay ? meshopt_SimplifyLockBorder : 0, nullptr);
  kept.resize(left / 3);
  return with_triangles(mesh, kept);
}

}  // namespace ovimap
