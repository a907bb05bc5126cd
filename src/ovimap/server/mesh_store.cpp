// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/mesh_store.h"

#include <algorithm>

#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

ChunkListing listing_of(const MeshChunk& chunk) {
  ChunkListing listing{chunk.index, chunk.version, chunk.patches.size(), 0, 0};
  for (const SurfacePatch& patch : chunk.patches) {
    listing.vertices += patch.mesh.vertices.size();
    listing.triangles += patch.mesh.triangles.size();
  }
  return listing;
}

}  // namespace

void MeshStore::replace(const Mesh& mesh) {
  const std::uint64_t version = this->version() + 1;
  std::vector<MeshChunk> fine = cut_into_chunks(mesh, grid_, version);
  std::array<Chunks, kLevels> levels;
  for (Chunks& level : levels) level.resize(fine.size());
  parallel_for(fine.size(), 1, [&](std::size_t i) {
    levels[1][i] = std::make_shared<MeshChunk>(coarser_chunk(
        fine[i], config_.coarse_share, config_.coarse_error_voxels * grid_.voxel_size_m));
    levels[0][i] = std::make_shared<MeshChunk>(std::move(fine[i]));
  });
  const std::lock_guard lock(mutex_);
  levels_ = std::move(levels);
  version_ = version;
}

std::uint64_t MeshStore::version() const {
  const std::lock_guard lock(mutex_);
  return version_;
}

std::vector<ChunkListing> MeshStore::list(int level, std::uint64_t since) const {
  const std::lock_guard lock(mutex_);
  std::vector<ChunkListing> result;
  for (const auto& chunk : levels_[static_cast<std::size_t>(level)])
    if (chunk->version > since) result.push_back(listing_of(*chunk));
  return result;
}

std::shared_ptr<const MeshChunk> MeshStore::find(int level, const Eigen::Vector3i& index) const {
  const std::lock_guard lock(mutex_);
  const Chunks& chunks = levels_[static_cast<std::size_t>(level)];
  const auto key = [](const auto& chunk) { return pack_index(chunk->index); };
  const auto found = std::lower_bound(
      chunks.begin(), chunks.end(), pack_index(index),
      [&](const auto& chunk, std::uint64_t wanted) { return key(chunk) < wanted; });
  return found != chunks.end() && (*found)->index == index ? *found : nullptr;
}

}  // namespace ovimap
