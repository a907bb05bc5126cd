// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "ovimap/geometry/mesh.h"
#include "ovimap/map/voxels/voxel_block.h"

namespace ovimap {

/// How the surface of a map is cut for sending: blocks, and cubes of blocks, the chunks. Cells of
/// the mesh lie between voxel centres, so a block's surface is half a voxel off its voxels.
struct ChunkGrid {
  static constexpr int kChunkBlocks =
      16;  ///< a room has some tens of chunks, a floor some hundreds

  float voxel_size_m = 0.01f;

  float block_m() const { return voxel_size_m * kBlockSide; }
  float edge_m() const { return block_m() * kChunkBlocks; }
  /// The corner of a chunk with the smallest coordinates. World, metres.
  Eigen::Vector3f origin(const Eigen::Vector3i& chunk) const {
    return chunk.cast<float>() * edge_m() + Eigen::Vector3f::Constant(0.5f * voxel_size_m);
  }
  /// The block that owns the cell around a point of the surface.
  BlockIndex block_of(const Eigen::Vector3f& point) const {
    return floor_to_int((point.array() - 0.5f * voxel_size_m).matrix() / block_m());
  }
  static Eigen::Vector3i chunk_of(const BlockIndex& block) {
    return {block.x() >> 4, block.y() >> 4, block.z() >> 4};  // floor division for either sign
  }
};

/// The surface of one block (at the coarse level: of a whole chunk, called by its first block),
/// complete in itself. The labels of its vertices are the map's, not ids of objects: which label
/// belongs to which object changes more often than the surface.
struct SurfacePatch {
  BlockIndex block = BlockIndex::Zero();
  std::uint64_t version = 0;  ///< of the update that made it
  std::shared_ptr<const Mesh> mesh;
  std::uint8_t error =
      0;  ///< of its block, error_byte (map/surface/surface_precision.h); 0: unknown
};

struct MeshChunk {
  Eigen::Vector3i index = Eigen::Vector3i::Zero();
  std::uint64_t version = 0;          ///< of the newest patch
  std::vector<SurfacePatch> patches;  ///< ordered by block (z, y, x)
};

/// error_byte of blocks, by pack_index.
using BlockErrors = std::map<std::uint64_t, std::uint8_t>;

/// Cuts a mesh with normals, colours and labels into chunks, ordered by index (z, y, x). A triangle
/// belongs to the block of its centre; vertices that several parts need are copied.
std::vector<MeshChunk> cut_into_chunks(const Mesh& mesh, const ChunkGrid& grid,
                                       std::uint64_t version);

/// The same chunks with few triangles: one patch each. The border of a chunk stays as it is, so
/// that neighbours meet and each can be made anew alone. `triangle_share` of the triangles are
/// kept where that moves the surface by no more than `max_error_m`.
MeshChunk coarser_chunk(const MeshChunk& chunk, float triangle_share, float max_error_m);

/// What the patches say of their blocks.
BlockErrors errors_of(const MeshChunk& chunk);

/// Some triangles of a mesh, with the vertices they need.
Mesh part_of_mesh(const Mesh& mesh, const std::vector<std::uint32_t>& triangles);

/// All patches in one mesh; vertices at the same place become one.
Mesh welded(const MeshChunk& chunk);

}  // namespace ovimap
