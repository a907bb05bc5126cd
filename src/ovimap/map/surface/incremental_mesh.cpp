// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/surface/incremental_mesh.h"

#include <algorithm>
#include <bit>

#include "ovimap/base/parallel.h"
#include "ovimap/map/surface/cell_rows.h"
#include "ovimap/map/surface/marching_cubes_table.h"
#include "ovimap/map/surface/mesh_vertex.h"
#include "ovimap/map/voxels/block_tiles.h"

namespace ovimap {

namespace {

constexpr std::size_t kPatchesPerTask = 16;
constexpr int kSide = CellRows::kSide;

/// Extracts the patches of one block after another; one per task.
class PatchMesher {
 public:
  explicit PatchMesher(const VoxelMap& map) : map_(map) { vertex_of_edge_.fill(kNoVertex); }

  /// Empty when the surface misses the block. Takes no more memory than it needs.
  Mesh extract(std::uint32_t slot) {
    CellRows cells(map_, slot);
    mesh_.vertices.clear(), mesh_.colors.clear(), mesh_.labels.clear(), mesh_.triangles.clear();
    for (int z = 0; z < kBlockSide; ++z)
      for (int y = 0; y < kBlockSide; ++y)
        for (unsigned row = cells.surface_cells(y, z); row != 0; row &= row - 1)
          add_cell(cells, map_.block_index(slot), {std::countr_zero(row), y, z});
    for (const std::size_t edge : used_edges_) vertex_of_edge_[edge] = kNoVertex;
    used_edges_.clear();
    return mesh_;
  }

 private:
  static constexpr std::uint16_t kNoVertex = 0xffff;

  void add_cell(const CellRows& cells, const BlockIndex& block, const Eigen::Vector3i& cell) {
    const unsigned inside = cells.inside_corners(cell.x(), cell.y(), cell.z());
    const CellTriangles& triangles = marching_cubes_table()[inside];
    for (std::size_t t = 0; t < triangles.count; ++t) {
      std::array<std::uint32_t, 3> indices;
      for (std::size_t k = 0; k < 3; ++k)
        indices[k] = vertex(cells, block, cell, triangles.edges[t][k]);
      mesh_.triangles.push_back(indices);
    }
  }

  std::uint32_t vertex(const CellRows& cells, const BlockIndex& block, const Eigen::Vector3i& cell,
                       int edge) {
    const int corner = kEdgeStart[static_cast<std::size_t>(edge)], axis = edge_axis(edge);
    const Eigen::Vector3i start =
        cell + Eigen::Vector3i(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    const auto key =
        static_cast<std::size_t>(3 * (start.x() + kSide * (start.y() + kSide * start.z())) + axis);
    if (vertex_of_edge_[key] == kNoVertex) {
      vertex_of_edge_[key] = static_cast<std::uint16_t>(mesh_.vertices.size());
      used_edges_.push_back(key);
      add_vertex(cells, block, start, axis);
    }
    return vertex_of_edge_[key];
  }

  void add_vertex(const CellRows& cells, const BlockIndex& block, const Eigen::Vector3i& start,
                  int axis) {
    const auto end_at = [&](const Eigen::Vector3i& at) -> MeshEdgeEnd {
      return {cells.block(at.x(), at.y(), at.z()),
              voxel_offset(at.x() & 7, at.y() & 7, at.z() & 7)};
    };
    const MeshVertex made = mesh_vertex(map_, {block * kBlockSide + start, axis, end_at(start),
                                               end_at(start + Eigen::Vector3i::Unit(axis))});
    mesh_.vertices.push_back(made.position);
    mesh_.colors.push_back(made.color);
    mesh_.labels.push_back(made.label);
  }

  const VoxelMap& map_;
  std::array<std::uint16_t, 3 * kSide * kSide * kSide> vertex_of_edge_;
  std::vector<std::size_t> used_edges_;
  Mesh mesh_;  ///< of the present block
};

}  // namespace

/// The visited blocks, and those whose cells reach into one of them.
std::vector<std::uint32_t> IncrementalMesh::touched(const VoxelMap& map,
                                                    std::span<const std::uint32_t> visited) {
  std::vector<std::uint32_t> slots;
  const auto touch = [&](std::uint32_t slot) {
    if (slot == kNoBlock || touched_in_[slot] == version_) return;
    touched_in_[slot] = version_;
    slots.push_back(slot);
  };
  for (const std::uint32_t slot : visited) {
    touch(slot);
    const BlockIndex& index = map.block_index(slot);
    for (int i = 1; i < 8; ++i)
      touch(map.find_slot(index - BlockIndex(i & 1, i >> 1 & 1, i >> 2 & 1)));
  }
  std::sort(slots.begin(), slots.end());
  return slots;
}

std::vector<std::uint32_t> IncrementalMesh::update(const VoxelMap& map,
                                                   std::span<const std::uint32_t> visited) {
  ++version_;
  patches_.resize(map.block_count());
  touched_in_.resize(map.block_count(), 0);
  std::vector<std::uint32_t> slots = touched(map, visited);
  parallel_for_ranges(slots.size(), kPatchesPerTask, [&](std::size_t begin, std::size_t end) {
    PatchMesher mesher(map);
    for (std::size_t i = begin; i < end; ++i) {
      Mesh mesh = mesher.extract(slots[i]);
      std::unique_ptr<MeshPatch>& patch = patches_[slots[i]];
      patch = mesh.triangles.empty()
                  ? nullptr
                  : std::make_unique<MeshPatch>(MeshPatch{std::move(mesh), version_});
    }
  });
  return slots;
}

std::vector<Mesh> extract_patches(const VoxelMap& map, std::span<const std::uint32_t> slots) {
  PatchMesher mesher(map);
  std::vector<Mesh> patches;
  for (const std::uint32_t slot : slots) patches.push_back(mesher.extract(slot));
  return patches;
}

void for_each_patch(const VoxelMap& map, const std::function<void(Mesh&)>& visit) {
  for_each_part(map, [&](std::span<const Tile> tiles) {
    std::vector<std::vector<Mesh>> patches(tiles.size());
    parallel_for_ranges(tiles.size(), 2, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) patches[i] = extract_patches(map, tiles[i].slots);
    });
    for (std::vector<Mesh>& of_tile : patches)
      for (Mesh& patch : of_tile)
        if (!patch.triangles.empty()) visit(patch);
  });
}

}  // namespace ovimap
