// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/surface/mesh_extraction.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <Eigen/Geometry>

#include "ovimap/base/parallel.h"
#include "ovimap/map/surface/marching_cubes_table.h"
#include "ovimap/map/surface/mesh_vertex.h"
#include "ovimap/map/voxels/block_tiles.h"

namespace ovimap {

namespace {

constexpr std::size_t kMeshedTilesPerTask = 1;
constexpr int kCellSide = kBlockSide + 1;  // a block's cells reach one voxel into its neighbours
constexpr int kEdges = kBlockVoxels * 3;
constexpr std::uint16_t kNoVertex = 0xffff;

/// The voxels of a block and the first layer of its seven upper neighbours.
class Neighbourhood {
 public:
  Neighbourhood(const VoxelMap& map, std::uint32_t slot) {
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3i offset(i & 1, i >> 1 & 1, i >> 2 & 1);
      blocks_[i] = i == 0 ? &map.block(slot) : map.find(map.block_index(slot) + offset);
    }
    const float min_weight = map.config().min_mesh_weight;
    for (int z = 0, n = 0; z < kCellSide; ++z)
      for (int y = 0; y < kCellSide; ++y)
        for (int x = 0; x < kCellSide; ++x, ++n) {
          const VoxelBlock* block = blocks_[which(x, y, z)];
          const auto v = static_cast<std::size_t>(voxel_offset(x & 7, y & 7, z & 7));
          observed_[n] = block && block->weight[v] > min_weight;
          tsdf_[n] = block ? block->tsdf[v] : VoxelBlock::Tsdf{0};
        }
  }

  bool observed(int x, int y, int z) const { return observed_[at(x, y, z)]; }
  bool inside(int x, int y, int z) const { return tsdf_[at(x, y, z)] < 0; }
  const VoxelBlock& block(int x, int y, int z) const { return *blocks_[which(x, y, z)]; }

 private:
  static int at(int x, int y, int z) { return x + kCellSide * (y + kCellSide * z); }
  static int which(int x, int y, int z) {
    return x / kBlockSide + 2 * (y / kBlockSide) + 4 * (z / kBlockSide);
  }

  const VoxelBlock* blocks_[8];
  bool observed_[kCellSide * kCellSide * kCellSide];
  VoxelBlock::Tsdf tsdf_[kCellSide * kCellSide * kCellSide];
};

/// The part of the mesh that one block owns: vertices on the edges that start in it, triangles of
/// its cells.
struct BlockMesh {
  std::unique_ptr<std::array<std::uint16_t, kEdges>>
      vertex_of_edge;  ///< null: the surface misses the block
  Mesh part;           ///< triangles hold global vertex indices
  std::uint32_t first_vertex = 0;
};

class BlockMesher {
 public:
  BlockMesher(const VoxelMap& map, std::vector<BlockMesh>& meshes,
              const std::vector<std::uint32_t>& slots)
      : map_(map), meshes_(meshes), slots_(slots) {}

  void add_vertices(std::size_t i) const {
    const Neighbourhood near(map_, slots_[i]);
    for (int z = 0; z < kBlockSide; ++z)
      for (int y = 0; y < kBlockSide; ++y)
        for (int x = 0; x < kBlockSide; ++x)
          for (int axis = 0; axis < 3; ++axis) add_vertex(near, i, {x, y, z}, axis);
  }

  /// Call after all blocks have their vertices. `mesh_of_slot` finds the neighbours' parts.
  void add_triangles(std::size_t i, const std::vector<std::uint32_t>& mesh_of_slot) const {
    const Neighbourhood near(map_, slots_[i]);
    for (int z = 0; z < kBlockSide; ++z)
      for (int y = 0; y < kBlockSide; ++y)
        for (int x = 0; x < kBlockSide; ++x) add_cell(near, i, {x, y, z}, mesh_of_slot);
  }

 private:
  void add_vertex(const Neighbourhood& near, std::size_t i, const Eigen::Vector3i& a,
                  int axis) const {
    const Eigen::Vector3i b = a + Eigen::Vector3i::Unit(axis);
    if (near.inside(a.x(), a.y(), a.z()) == near.inside(b.x(), b.y(), b.z())) return;
    if (!near.observed(a.x(), a.y(), a.z()) || !near.observed(b.x(), b.y(), b.z())) return;
    BlockMesh& mesh = meshes_[i];
    if (!mesh.vertex_of_edge) {
      mesh.vertex_of_edge = std::make_unique<std::array<std::uint16_t, kEdges>>();
      mesh.vertex_of_edge->fill(kNoVertex);
    }
    const auto end_at = [&](const Eigen::Vector3i& at) -> MeshEdgeEnd {
      return {&near.block(at.x(), at.y(), at.z()),
              voxel_offset(at.x() & 7, at.y() & 7, at.z() & 7)};
    };
    const MeshVertex made = mesh_vertex(
        map_, {map_.block_index(slots_[i]) * kBlockSide + a, axis, end_at(a), end_at(b)});
    const auto edge = static_cast<std::size_t>(voxel_offset(a.x(), a.y(), a.z()) * 3 + axis);
    (*mesh.vertex_of_edge)[edge] = static_cast<std::uint16_t>(mesh.part.vertices.size());
    mesh.part.vertices.push_back(made.position);
    mesh.part.colors.push_back(made.color);
    mesh.part.labels.push_back(made.label);
  }

  void add_cell(const Neighbourhood& near, std::size_t i, const Eigen::Vector3i& cell,
                const std::vector<std::uint32_t>& mesh_of_slot) const {
    int inside = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const int x = cell.x() + (corner & 1), y = cell.y() + (corner >> 1 & 1),
                z = cell.z() + (corner >> 2 & 1);
      if (!near.observed(x, y, z)) return;
      inside |= near.inside(x, y, z) << corner;
    }
    const CellTriangles& triangles = marching_cubes_table()[static_cast<std::size_t>(inside)];
    for (std::size_t t = 0; t < triangles.count; ++t) {
      std::array<std::uint32_t, 3> indices;
      for (std::size_t k = 0; k < 3; ++k)
        indices[k] = global_vertex(near, i, cell, triangles.edges[t][k], mesh_of_slot);
      meshes_[i].part.triangles.push_back(indices);
    }
  }

  std::uint32_t global_vertex(const Neighbourhood& near, std::size_t i, const Eigen::Vector3i& cell,
                              int edge, const std::vector<std::uint32_t>& mesh_of_slot) const {
    const int corner = kEdgeStart[static_cast<std::size_t>(edge)];
    const Eigen::Vector3i at = cell + Eigen::Vector3i(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    const bool own = (at.array() < kBlockSide).all();
    const std::uint32_t slot =
        own ? slots_[i] : map_.find_slot(near.block(at.x(), at.y(), at.z()).index);
    const BlockMesh& mesh = meshes_[mesh_of_slot[slot]];
    const auto key = static_cast<std::size_t>(voxel_offset(at.x() & 7, at.y() & 7, at.z() & 7) * 3 +
                                              edge_axis(edge));
    return mesh.first_vertex + (*mesh.vertex_of_edge)[key];
  }

  const VoxelMap& map_;
  std::vector<BlockMesh>& meshes_;
  const std::vector<std::uint32_t>& slots_;
};

template <class Value>
void release(std::vector<Value>& values) {
  std::vector<Value>().swap(values);
}

/// Joins the parts, which go, and leaves out vertices that no triangle uses (edges at the border of
/// observed space).
Mesh join(std::vector<BlockMesh> meshes, std::uint32_t vertex_count) {
  constexpr std::uint32_t kUnused = ~std::uint32_t{0};
  std::vector<std::uint32_t> packed(vertex_count, kUnused);
  std::size_t used = 0, triangles = 0;
  for (BlockMesh& mesh : meshes) {
    mesh.vertex_of_edge.reset();
    triangles += mesh.part.triangles.size();
    for (const auto& triangle : mesh.part.triangles)
      for (const std::uint32_t vertex : triangle)
        if (std::exchange(packed[vertex], 0) == kUnused) ++used;
  }
  Mesh result;
  result.vertices.reserve(used);
  result.colors.reserve(used);
  result.labels.reserve(used);
  for (BlockMesh& mesh : meshes) {
    for (std::uint32_t v = 0; v < mesh.part.vertices.size(); ++v) {
      if (packed[mesh.first_vertex + v] == kUnused) continue;
      packed[mesh.first_vertex + v] = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.push_back(mesh.part.vertices[v]);
      result.colors.push_back(mesh.part.colors[v]);
      result.labels.push_back(mesh.part.labels[v]);
    }
    release(mesh.part.vertices);
    release(mesh.part.colors);
    release(mesh.part.labels);
  }
  result.triangles.reserve(triangles);
  for (BlockMesh& mesh : meshes) {
    for (const auto& [a, b, c] : mesh.part.triangles)
      result.triangles.push_back({packed[a], packed[b], packed[c]});
    release(mesh.part.triangles);
  }
  add_normals(result);
  return result;
}

}  // namespace

void add_normals(Mesh& mesh) {
  mesh.normals.assign(mesh.vertices.size(), Eigen::Vector3f::Zero());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3f twice_area =
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
    for (std::uint32_t vertex : {a, b, c}) mesh.normals[vertex] += twice_area;
  }
  for (Eigen::Vector3f& normal : mesh.normals) normal.normalize();
}

Mesh extract_mesh(const VoxelMap& map) {
  const std::vector<std::uint32_t> slots = map.ordered_slots();
  std::vector<std::uint32_t> mesh_of_slot(slots.size());
  for (std::uint32_t i = 0; i < slots.size(); ++i) mesh_of_slot[slots[i]] = i;
  std::vector<BlockMesh> meshes(slots.size());
  const BlockMesher mesher(map, meshes, slots);
  const auto for_each_mesh = [&](const auto& make) {
    for_each_part(map, [&](std::span<const Tile> tiles) {
      parallel_for(tiles.size(), kMeshedTilesPerTask, [&](std::size_t t) {
        for (const std::uint32_t slot : tiles[t].slots) make(mesh_of_slot[slot]);
      });
    });
  };
  for_each_mesh([&](std::size_t i) { mesher.add_vertices(i); });
  std::uint32_t vertex_count = 0;
  for (BlockMesh& mesh : meshes) {
    mesh.first_vertex = vertex_count;
    vertex_count += static_cast<std::uint32_t>(mesh.part.vertices.size());
  }
  for_each_mesh([&](std::size_t i) { mesher.add_triangles(i, mesh_of_slot); });
  return join(std::move(meshes), vertex_count);
}

}  // namespace ovimap
