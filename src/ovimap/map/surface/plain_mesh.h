// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "ovimap/map/surface/marching_cubes_table.h"
#include "ovimap/map/surface/mesh_vertex.h"

namespace ovimap::plain {

using Corners = std::array<MeshVertex, 3>;

/// The voxel at global coordinates; a null block where there is none.
inline MeshEdgeEnd voxel_at(const VoxelMap& map, const Eigen::Vector3i& at) {
  const BlockIndex block(at.x() >> 3, at.y() >> 3, at.z() >> 3);
  return {map.find(block), voxel_offset(at.x() & 7, at.y() & 7, at.z() & 7)};
}

/// The triangles of the cell between a voxel and its upper neighbours.
inline void add_cell(const VoxelMap& map, const Eigen::Vector3i& cell, std::vector<Corners>& to) {
  const auto corner_at = [&](int corner) {
    return Eigen::Vector3i(cell + Eigen::Vector3i(corner & 1, corner >> 1 & 1, corner >> 2 & 1));
  };
  std::size_t inside = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const MeshEdgeEnd end = voxel_at(map, corner_at(corner));
    const auto voxel = static_cast<std::size_t>(end.voxel);
    if (!end.block || !(end.block->weight[voxel] > map.config().min_mesh_weight)) return;
    if (end.block->tsdf[voxel] < 0) inside |= std::size_t{1} << corner;
  }
  const CellTriangles& triangles = marching_cubes_table()[inside];
  for (std::size_t t = 0; t < triangles.count; ++t) {
    Corners& corners = to.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const int edge = triangles.edges[t][k], axis = edge_axis(edge);
      const Eigen::Vector3i start = corner_at(kEdgeStart[static_cast<std::size_t>(edge)]);
      corners[k] = mesh_vertex(map, {start, axis, voxel_at(map, start),
                                     voxel_at(map, start + Eigen::Vector3i::Unit(axis))});
    }
  }
}

/// Marching cubes, cell by cell, every corner looked up by itself: what the fast meshes are held
/// against.
inline std::vector<Corners> mesh_triangles(const VoxelMap& map) {
  std::vector<Corners> triangles;
  for (const std::uint32_t slot : map.ordered_slots())
    for (int z = 0; z < kBlockSide; ++z)
      for (int y = 0; y < kBlockSide; ++y)
        for (int x = 0; x < kBlockSide; ++x)
          add_cell(map, map.block_index(slot) * kBlockSide + Eigen::Vector3i(x, y, z), triangles);
  return triangles;
}

}  // namespace ovimap::plain
