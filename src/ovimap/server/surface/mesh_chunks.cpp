// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/surface/mesh_chunks.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <unordered_map>

#include <meshoptimizer.h>

#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

using TrianglesByKey = std::map<std::uint64_t, std::vector<std::uint32_t>>;

std::vector<std::uint64_t> block_keys(const Mesh& mesh, const ChunkGrid& grid) {
  constexpr std::size_t kTrianglesPerTask = 16384;
  std::vector<std::uint64_t> keys(mesh.triangles.size());
  parallel_for(keys.size(), kTrianglesPerTask, [&](std::size_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Eigen::Vector3f center = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3.f;
    keys[t] = pack_index(grid.block_of(center));
  });
  return keys;
}

MeshChunk make_chunk(const Mesh& mesh, const std::vector<std::uint32_t>& triangles,
                     const std::vector<std::uint64_t>& keys, std::uint64_t version) {
  TrianglesByKey by_block;
  for (const std::uint32_t t : triangles) by_block[keys[t]].push_back(t);
  MeshChunk chunk;
  chunk.version = version;
  chunk.index = ChunkGrid::chunk_of(unpack_index(by_block.begin()->first));
  for (const auto& [block, own] : by_block)
    chunk.patches.push_back(
        {unpack_index(block), version, std::make_shared<Mesh>(part_of_mesh(mesh, own)), 0});
  return chunk;
}

/// Appends `from`'s vertex to `to`; attributes that `from` lacks stay out.
void copy_vertex(const Mesh& from, std::uint32_t vertex, Mesh& to) {
  to.vertices.push_back(from.vertices[vertex]);
  if (!from.normals.empty()) to.normals.push_back(from.normals[vertex]);
  if (!from.colors.empty()) to.colors.push_back(from.colors[vertex]);
  if (!from.labels.empty()) to.labels.push_back(from.labels[vertex]);
}

struct PositionHash {
  std::size_t operator()(const Eigen::Vector3f& position) const {
    std::uint32_t bits[3];
    std::memcpy(bits, position.data(), sizeof bits);
    return (bits[0] * 73856093ull) ^ (bits[1] * 19349663ull) ^ (bits[2] * 83492791ull);
  }
};

const unsigned int* flat(const Mesh& mesh) {
  return mesh.triangles.empty() ? nullptr : mesh.triangles.front().data();
}

}  // namespace

Mesh part_of_mesh(const Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
  Mesh part;
  std::unordered_map<std::uint32_t, std::uint32_t> place;
  for (const std::uint32_t t : triangles) {
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t vertex = mesh.triangles[t][c];
      const auto next = static_cast<std::uint32_t>(part.vertices.size());
      const auto [entry, is_new] = place.try_emplace(vertex, next);
      if (is_new) copy_vertex(mesh, vertex, part);
      corners[c] = entry->second;
    }
    part.triangles.push_back(corners);
  }
  return part;
}

std::vector<MeshChunk> cut_into_chunks(const Mesh& mesh, const ChunkGrid& grid,
                                       std::uint64_t version) {
  const std::vector<std::uint64_t> keys = block_keys(mesh, grid);
  TrianglesByKey by_chunk;
  for (std::uint32_t t = 0; t < keys.size(); ++t)
    by_chunk[pack_index(ChunkGrid::chunk_of(unpack_index(keys[t])))].push_back(t);
  std::vector<const std::vector<std::uint32_t>*> parts;
  for (const auto& [chunk, triangles] : by_chunk) parts.push_back(&triangles);
  std::vector<MeshChunk> chunks(parts.size());
  parallel_for(parts.size(), 1,
               [&](std::size_t i) { chunks[i] = make_chunk(mesh, *parts[i], keys, version); });
  return chunks;
}

Mesh welded(const MeshChunk& chunk) {
  Mesh mesh;
  std::unordered_map<Eigen::Vector3f, std::uint32_t, PositionHash> place;
  for (const SurfacePatch& patch : chunk.patches) {
    std::vector<std::uint32_t> vertex_of(patch.mesh->vertices.size());
    for (std::uint32_t v = 0; v < vertex_of.size(); ++v) {
      const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
      const auto [entry, is_new] = place.try_emplace(patch.mesh->vertices[v], next);
      if (is_new) copy_vertex(*patch.mesh, v, mesh);
      vertex_of[v] = entry->second;
    }
    for (const auto& [a, b, c] : patch.mesh->triangles)
      mesh.triangles.push_back({vertex_of[a], vertex_of[b], vertex_of[c]});
  }
  return mesh;
}

MeshChunk coarser_chunk(const MeshChunk& chunk, float triangle_share, float max_error_m) {
  Mesh mesh = welded(chunk);
  if (mesh.triangles.empty())
    return {chunk.index,
            chunk.version,
            {{chunk.index * ChunkGrid::kChunkBlocks, chunk.version, std::make_shared<Mesh>(), 0}}};
  const std::size_t indices = mesh.triangles.size() * 3;
  const float* positions = mesh.vertices.front().data();
  constexpr std::size_t kStride = sizeof(Eigen::Vector3f);
  const float scale = meshopt_simplifyScale(positions, mesh.vertices.size(), kStride);
  std::vector<std::array<std::uint32_t, 3>> kept(mesh.triangles.size());
  const auto target = static_cast<std::size_t>(static_cast<float>(indices) * triangle_share);
  const std::size_t left = meshopt_simplify(
      kept.front().data(), flat(mesh), indices, positions, mesh.vertices.size(), kStride, target,
      max_error_m / std::max(scale, 1e-6f), meshopt_SimplifyLockBorder, nullptr);
  kept.resize(left / 3);
  mesh.triangles = std::move(kept);
  std::vector<std::uint32_t> all(mesh.triangles.size());
  for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
  MeshChunk result;
  result.index = chunk.index;
  result.version = chunk.version;
  result.patches.push_back({chunk.index * ChunkGrid::kChunkBlocks, chunk.version,
                            std::make_shared<Mesh>(part_of_mesh(mesh, all)), 0});
  return result;
}

BlockErrors errors_of(const MeshChunk& chunk) {
  BlockErrors errors;
  for (const SurfacePatch& patch : chunk.patches)
    if (patch.error > 0) errors[pack_index(patch.block)] = patch.error;
  return errors;
}

}  // namespace ovimap
