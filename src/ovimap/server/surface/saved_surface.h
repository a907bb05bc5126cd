// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <mutex>
#include <shared_mutex>
#include <thread>

#include "ovimap/base/memory/recently_used.h"
#include "ovimap/map/voxels/voxel_map.h"
#include "ovimap/server/surface/levels_file.h"

namespace ovimap {

struct SavedSurfaceConfig {
  /// Levels 1 and 2. What is seen as the smallest of pictures need not meet its neighbours.
  std::array<LevelOfDetail, ServedSurface::kLevels - 1> levels = {{{}, {0.1f, 10.f, false}}};
  std::size_t kept_bytes = 256 << 20;      ///< of encoded chunks of level 0
  std::filesystem::path levels_file = {};  ///< where levels 1 and 2 are kept; empty: nowhere
};

/// The surface of a saved map. A chunk is made out of its voxels when somebody asks for it, and the
/// levels with less detail, which are small, are made ahead by a thread of its own and stay: so a
/// map of any size can be served at once, and in little memory.
class SavedSurface final : public ServedSurface {
 public:
  /// `map`: its voxels are best read by tiles (load_map_by_tiles). `version`: of all chunks.
  /// `shown`: what clients may know of before, while the map was made.
  SavedSurface(VoxelMap map, const SavedSurfaceConfig& config = {}, std::uint64_t version = 1,
               ShownBlocks shown = {});
  ~SavedSurface() override;

  std::uint64_t version() const override { return version_; }
  std::vector<ChunkListing> list(int level, std::uint64_t since = 0) const override;
  std::shared_ptr<const std::string> encoded(int level, const Eigen::Vector3i& index,
                                             std::uint64_t since = 0) const override;
  /// Makes the chunks that were not made yet.
  BlockErrors errors() const override;
  void for_each_patch(const Eigen::AlignedBox3f& box,
                      const std::function<void(const SurfacePatch&)>& visit) const override;

 private:
  using Bytes = std::shared_ptr<const std::string>;
  struct Chunk {
    Eigen::Vector3i index = Eigen::Vector3i::Zero();
    std::vector<std::uint32_t> slots;                    ///< of its blocks
    mutable std::shared_ptr<const MadeChunk> made = {};  ///< null: not yet. Guarded by `mutex_`
  };
  using SharedMesh = std::shared_ptr<const Mesh>;
  const Chunk* find(const Eigen::Vector3i& index) const;
  SharedMesh mesh_of(const Chunk& chunk) const;
  BlockErrors errors_of(const Chunk& chunk) const;
  MeshChunk in_one_patch(const Chunk& chunk, SharedMesh mesh) const;
  std::shared_ptr<const MadeChunk> known(const Chunk& chunk) const;
  std::shared_ptr<const MadeChunk> made(const Chunk& chunk, SharedMesh mesh = nullptr) const;
  std::shared_ptr<const MadeChunk> make(const Chunk& chunk, SharedMesh mesh) const;
  Bytes make_fine(const Chunk& chunk, std::uint64_t since) const;
  bool take_kept() const;
  void make_all() const;

  const SavedSurfaceConfig config_;
  const std::uint64_t version_;
  const ShownBlocks shown_;
  VoxelMap map_;
  mutable std::shared_mutex voxels_;  ///< shared by whoever reads voxels; alone, who lets them go
  mutable std::atomic<unsigned> read_ = 0;  ///< how many chunks' voxels
  std::vector<Chunk> chunks_;               ///< ordered by index (z, y, x)
  mutable std::mutex mutex_;
  mutable RecentlyUsed<std::uint64_t, Bytes> fine_;  ///< by pack_index
  std::atomic<bool> ending_ = false;
  std::thread ahead_;
};

}  // namespace ovimap
