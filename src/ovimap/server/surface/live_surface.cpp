// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/surface/live_surface.h"

#include <algorithm>
#include <iterator>
#include <map>

#include "ovimap/server/surface/chunk_encoding.h"

namespace ovimap {

namespace {

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

}  // namespace

void LiveSurface::update(std::vector<SurfacePatch> patches) {
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
    const auto before = find(unpack_index(key));
    changed.push_back(std::make_shared<MeshChunk>(
        with_patches(before ? *before : MeshChunk{unpack_index(key), 0, {}}, std::move(own))));
  }
  const std::lock_guard lock(mutex_);
  for (auto& chunk : changed) put(chunks_, std::move(chunk));
  version_ = version;
}

std::uint64_t LiveSurface::version() const {
  const std::lock_guard lock(mutex_);
  return version_;
}

LiveSurface::Chunks LiveSurface::chunks() const {
  const std::lock_guard lock(mutex_);
  return chunks_;
}

std::shared_ptr<const MeshChunk> LiveSurface::find(const Eigen::Vector3i& index) const {
  const std::lock_guard lock(mutex_);
  const auto found = std::lower_bound(chunks_.begin(), chunks_.end(), pack_index(index), by_index);
  return found != chunks_.end() && (*found)->index == index ? *found : nullptr;
}

std::vector<ChunkListing> LiveSurface::list(int level, std::uint64_t since) const {
  std::vector<ChunkListing> result;
  if (level > 0) return result;
  for (const auto& chunk : chunks())
    if (chunk->version > since) result.push_back({chunk->index, chunk->version, totals_of(*chunk)});
  return result;
}

std::shared_ptr<const std::string> LiveSurface::encoded(int level, const Eigen::Vector3i& index,
                                                        std::uint64_t since) const {
  const auto chunk = level == 0 ? find(index) : nullptr;
  if (!chunk) return nullptr;
  return std::make_shared<const std::string>(encode_chunk(*chunk, grid(), level, since));
}

ShownBlocks LiveSurface::blocks() const {
  ShownBlocks blocks;
  for_each_patch(all_space(), [&](const SurfacePatch& patch) {
    blocks[pack_index(ChunkGrid::chunk_of(patch.block))].push_back(patch.block);
  });
  return blocks;
}

BlockErrors LiveSurface::errors() const {
  BlockErrors all;
  for_each_patch(all_space(), [&](const SurfacePatch& patch) {
    if (patch.error > 0) all[pack_index(patch.block)] = patch.error;
  });
  return all;
}

void LiveSurface::for_each_patch(const Eigen::AlignedBox3f& box,
                                 const std::function<void(const SurfacePatch&)>& visit) const {
  for (const auto& chunk : chunks())
    if (meets(box, chunk->index))
      for (const SurfacePatch& patch : chunk->patches) visit(patch);
}

}  // namespace ovimap
