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

/// The surface of one block (of a saved map: of a whole chunk, called by its first block), complete
/// in itself. The labels of its vertices are the map's, not ids of objects: which label
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

/// Blocks of each chunk, by pack_index of the chunk.
using ShownBlocks = std::map<std::uint64_t, std::vector<BlockIndex>>;

/// How much of it there is.
struct ChunkTotals {
  std::uint32_t patches = 0, vertices = 0, triangles = 0;
};

/// Of the patches newer than `since`.
ChunkTotals totals_of(const MeshChunk& chunk, std::uint64_t since = 0);

/// How much less detail a level has.
struct LevelOfDetail {
  float triangle_share = 0.1f;   ///< of those of the level before that are kept
  float max_error_voxels = 3.f;  ///< by which that may move the surface; else more are kept
  bool borders_stay = true;      ///< of chunks, so that neighbours of two levels meet
};

/// The same surface with fewer triangles, each of which keeps the corners' labels and colours.
Mesh in_less_detail(const Mesh& mesh, const LevelOfDetail& level, float voxel_size_m);

}  // namespace ovimap
