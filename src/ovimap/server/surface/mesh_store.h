// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "ovimap/server/surface/mesh_chunks.h"

namespace ovimap {

struct MeshLevelConfig {
  float coarse_share = 0.1f;        ///< of the triangles, at level 1
  float coarse_error_voxels = 3.f;  ///< by which the surface may move there
};

/// What a list of chunks says of one.
struct ChunkListing {
  Eigen::Vector3i index = Eigen::Vector3i::Zero();
  std::uint64_t version = 0;
  std::size_t patches = 0, vertices = 0, triangles = 0;
};

/// The map's surface, ready to be sent: level 0 is all of it, level 1 a coarse one for the first
/// picture and for slow machines. Thread-safe: one may write while many read.
class MeshStore {
 public:
  static constexpr int kLevels = 2;

  explicit MeshStore(const ChunkGrid& grid, const MeshLevelConfig& config = {})
      : grid_(grid), config_(config) {}

  /// Takes the whole surface, with the map's labels, as the next version. Blocks that had surface
  /// before and have none now get an empty patch.
  /// `errors`: how well the surface is known, by block.
  void replace(const Mesh& mesh, const BlockErrors& errors = {});

  /// Takes new patches of some blocks as the next version, at level 0 alone: a coarse surface of
  /// what still changes would cost more than it saves. Null meshes: the block has no surface.
  void update(std::vector<SurfacePatch> patches);

  /// 0: there is no surface yet.
  std::uint64_t version() const;
  /// Chunks with a version above `since`.
  std::vector<ChunkListing> list(int level, std::uint64_t since = 0) const;
  /// Null where there is no such chunk.
  std::shared_ptr<const MeshChunk> find(int level, const Eigen::Vector3i& index) const;
  /// How well the surface is known, of all blocks of level 0 that tell it.
  BlockErrors errors() const;
  /// All chunks of level 0.
  std::vector<std::shared_ptr<const MeshChunk>> chunks() const;
  const ChunkGrid& grid() const { return grid_; }

 private:
  using Chunks = std::vector<std::shared_ptr<const MeshChunk>>;  // ordered by index (z, y, x)

  const ChunkGrid grid_;
  const MeshLevelConfig config_;
  mutable std::mutex mutex_;
  std::array<Chunks, kLevels> levels_;
  std::uint64_t version_ = 0;
};

}  // namespace ovimap
