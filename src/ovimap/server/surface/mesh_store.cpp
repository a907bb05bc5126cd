// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/surface/mesh_store.h"

#include <algorithm>
#include <iterator>
#include <map>

#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

ChunkListing listing_of(const MeshChunk& chunk) {
  ChunkListing listing{chunk.index, chunk.version, chunk.patches.size(), 0, 0};
  for (const SurfacePatch& patch : chunk.patches) {
    listing.vertices += patch.mesh->vertices.size();
    listing.triangles += patch.mesh->triangles.size();
  }
  return listing;
}

bool by_block(const SurfacePatch& a, const SurfacePatch& b) {
  return pack_index(a.block) < pack_index(b.block);
}

/// The chunk with some patches exchanged. Meshes are shared, not copied.
MeshChunk with_patches(const MeshChunk& before, std::vector<SurfacePatch> fresh) {
  std::sort(fresh.begin(), fresh.end(), by_block);
  MeshChunk chunk{before.index, fresh.front().version, {}};
  std::set_union(fresh.begin(), fresh.end(), before.patches.begin(), before.patches.end(),
                 std::back_inserter(chunk.patches), by_block);
  return chunk;
}

bool by_index(const std::shared_ptr<const MeshChunk>& chunk, std::uint64_t wanted) {
  return pack_index(chunk->index) < wanted;
}

void put(std::vector<std::shared_ptr<const MeshChunk>>& chunks,
         std::shared_ptr<const MeshChunk> chunk) {
  const auto place =
      std::lower_bound(chunks.begin(), chunks.end(), pack_index(chunk->index), by_index);
  if (place != chunks.end() && (*place)->index == chunk->index)
    *place = std::move(chunk);
  else
    chunks.insert(place, std::move(chunk));
}

/// Gives the blocks of `before` that have no surface any more an empty patch among `now`.
void keep_emptied(const MeshChunk& before, std::uint64_t version, std::vector<MeshChunk>& now) {
  const std::uint64_t key = pack_index(before.index);
  auto chunk = std::lower_bound(
      now.begin(), now.end(), key,
      [](const MeshChunk& c, std::uint64_t wanted) { return pack_index(c.index) < wanted; });
  if (chunk == now.end() || chunk->index != before.index)
    chunk = now.insert(chunk, MeshChunk{before.index, version, {}});
  std::vector<SurfacePatch> emptied;
  std::set_difference(before.patches.begin(), before.patches.end(), chunk->patches.begin(),
                      chunk->patches.end(), std::back_inserter(emptied), by_block);
  for (SurfacePatch& patch : emptied) patch = {patch.block, version, std::make_shared<Mesh>(), 0};
  if (!emptied.empty()) *chunk = with_patches(*chunk, std::move(emptied));
}

}  // namespace

BlockErrors MeshStore::errors() const {
  BlockErrors all;
  for (const auto& chunk : chunks()) all.merge(errors_of(*chunk));
  return all;
}

void MeshStore::replace(const Mesh& mesh, const BlockErrors& errors) {
  const std::uint64_t version = this->version() + 1;
  std::vector<MeshChunk> fine = cut_into_chunks(mesh, grid_, version);
  for (MeshChunk& chunk : fine)
    for (SurfacePatch& patch : chunk.patches)
      if (const auto error = errors.find(pack_index(patch.block)); error != errors.end())
        patch.error = error->second;
  for (const auto& before : chunks()) keep_emptied(*before, version, fine);
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

void MeshStore::update(std::vector<SurfacePatch> patches) {
  if (patches.empty()) return;
  const std::uint64_t version = this->version() + 1;
  std::map<std::uint64_t, std::vector<SurfacePatch>> by_chunk;
  for (SurfacePatch& patch : patches) {
    patch.version = version;
    if (!patch.mesh) patch.mesh = std::make_shared<Mesh>();
    by_chunk[pack_index(ChunkGrid::chunk_of(patch.block))].push_back(std::move(patch));
  }
  Chunks changed;
  for (auto& [key, own] : by_chunk) {
    const auto before = find(0, unpack_index(key));
    changed.push_back(std::make_shared<MeshChunk>(
        with_patches(before ? *before : MeshChunk{unpack_index(key), 0, {}}, std::move(own))));
  }
  const std::lock_guard lock(mutex_);
  for (auto& chunk : changed) put(levels_[0], std::move(chunk));
  version_ = version;
}

std::uint64_t MeshStore::version() const {
  const std::lock_guard lock(mutex_);
  return version_;
}

std::vector<std::shared_ptr<const MeshChunk>> MeshStore::chunks() const {
  const std::lock_guard lock(mutex_);
  return levels_[0];
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
  const auto found = std::lower_bound(chunks.begin(), chunks.end(), pack_index(index), by_index);
  return found != chunks.end() && (*found)->index == index ? *found : nullptr;
}

}  // namespace ovimap
