// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/surface/saved_surface.h"

#include <algorithm>
#include <chrono>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"
#include "ovimap/map/surface/incremental_mesh.h"
#include "ovimap/map/surface/mesh_extraction.h"
#include "ovimap/map/surface/mesh_welding.h"
#include "ovimap/map/surface/surface_precision.h"
#include "ovimap/server/surface/chunk_encoding.h"

namespace ovimap {

SavedSurface::SavedSurface(VoxelMap map, const SavedSurfaceConfig& config, std::uint64_t version,
                           ShownBlocks shown)
    : ServedSurface(ChunkGrid{map.config().voxel_size_m}),
      config_(config),
      version_(version),
      shown_(std::move(shown)),
      map_(std::move(map)),
      fine_(config.kept_bytes) {
  std::map<std::uint64_t, std::vector<std::uint32_t>> by_chunk;
  for (const std::uint32_t slot : map_.ordered_slots())
    by_chunk[pack_index(ChunkGrid::chunk_of(map_.block_index(slot)))].push_back(slot);
  for (const auto& [key, blocks] : shown_) by_chunk[key];
  for (auto& [key, slots] : by_chunk)
    chunks_.push_back({unpack_index(key), std::move(slots), nullptr});
  ahead_ = std::thread([this] { make_all(); });
}

SavedSurface::~SavedSurface() {
  ending_ = true;
  ahead_.join();
}

const SavedSurface::Chunk* SavedSurface::find(const Eigen::Vector3i& index) const {
  const auto found = std::lower_bound(
      chunks_.begin(), chunks_.end(), pack_index(index),
      [](const Chunk& chunk, std::uint64_t key) { return pack_index(chunk.index) < key; });
  return found != chunks_.end() && found->index == index ? &*found : nullptr;
}

// ---------------------------------------------------------------------------------- how it is made

/// Of one thread alone: chunks are made side by side, and whoever waits for others while it holds
/// `voxels_` could be given a chunk that wants it alone.
SavedSurface::SharedMesh SavedSurface::mesh_of(const Chunk& chunk) const {
  constexpr unsigned kChunksBetween = 8;  // their voxels are more than what may stay
  if (++read_ % kChunksBetween == 0) {
    const std::unique_lock lock(voxels_);
    map_.trim();
  }
  const std::shared_lock lock(voxels_);
  Mesh mesh = welded(extract_patches(map_, chunk.slots));
  add_normals(mesh);
  return std::make_shared<const Mesh>(std::move(mesh));
}

BlockErrors SavedSurface::errors_of(const Chunk& chunk) const {
  const std::shared_lock lock(voxels_);
  BlockErrors errors;
  for (const std::uint32_t slot : chunk.slots)
    if (const auto error_m = surface_error_m(map_, map_.block(slot)))
      errors[pack_index(map_.block_index(slot))] = error_byte(error_m);
  return errors;
}

MeshChunk SavedSurface::in_one_patch(const Chunk& chunk, SharedMesh mesh) const {
  const BlockIndex first = chunk.index * ChunkGrid::kChunkBlocks;
  return {chunk.index, version_, {{first, version_, std::move(mesh), 0}}};
}

std::shared_ptr<const MadeChunk> SavedSurface::make(const Chunk& chunk, SharedMesh mesh) const {
  auto made = std::make_shared<MadeChunk>();
  made->index = chunk.index;
  made->errors = errors_of(chunk);
  made->totals[0] = totals_of(in_one_patch(chunk, mesh));
  for (std::size_t i = 0; i < config_.levels.size(); ++i) {
    mesh =
        std::make_shared<const Mesh>(in_less_detail(*mesh, config_.levels[i], grid().voxel_size_m));
    const MeshChunk coarse = in_one_patch(chunk, mesh);
    made->totals[i + 1] = totals_of(coarse);
    made->coarse[i] = std::make_shared<const std::string>(
        encode_chunk(coarse, grid(), static_cast<int>(i) + 1, 0, made->errors));
  }
  return made;
}

std::shared_ptr<const MadeChunk> SavedSurface::known(const Chunk& chunk) const {
  const std::lock_guard lock(mutex_);
  return chunk.made;
}

/// `mesh`: mesh_of the chunk, for whoever has it already.
std::shared_ptr<const MadeChunk> SavedSurface::made(const Chunk& chunk, SharedMesh mesh) const {
  if (auto made = known(chunk)) return made;
  auto made = make(chunk, mesh ? std::move(mesh) : mesh_of(chunk));
  const std::lock_guard lock(mutex_);
  return chunk.made = std::move(made);
}

/// What an earlier program made of the same voxels.
bool SavedSurface::take_kept() const {
  if (config_.levels_file.empty() || version_ != 1) return false;
  for (const auto& kept : read_levels(config_.levels_file))
    if (const Chunk* chunk = find(kept->index)) {
      const std::lock_guard lock(mutex_);
      chunk->made = kept;
    }
  return std::all_of(chunks_.begin(), chunks_.end(),
                     [&](const Chunk& chunk) { return known(chunk) != nullptr; });
}

void SavedSurface::make_all() const {
  constexpr std::chrono::seconds kWorthKeeping{1};
  try {
    if (take_kept()) return;
    const auto start = std::chrono::steady_clock::now();
    parallel_for(chunks_.size(), 1, [&](std::size_t i) {
      if (!ending_) made(chunks_[i]);
    });
    const bool keep = !config_.levels_file.empty() && version_ == 1 && !ending_ &&
                      std::chrono::steady_clock::now() - start > kWorthKeeping;
    MadeChunks all;
    for (std::size_t i = 0; keep && i < chunks_.size(); ++i) all.push_back(known(chunks_[i]));
    if (keep) write_levels(config_.levels_file, all);
  } catch (const Error&) {  // whoever asks for the chunk that cannot be read is told
  }
}

// ----------------------------------------------------------------------------------- what is asked

std::vector<ChunkListing> SavedSurface::list(int level, std::uint64_t since) const {
  std::vector<ChunkListing> result;
  if (since >= version_) return result;
  const std::lock_guard lock(mutex_);
  for (const Chunk& chunk : chunks_) {
    ChunkListing listing{chunk.index, version_, std::nullopt};
    if (chunk.made) listing.totals = chunk.made->totals[static_cast<std::size_t>(level)];
    const bool empty = chunk.made && chunk.made->totals[0].triangles == 0;
    if (!empty || shown_.contains(pack_index(chunk.index))) result.push_back(listing);
  }
  return result;
}

std::shared_ptr<const std::string> SavedSurface::encoded(int level, const Eigen::Vector3i& index,
                                                         std::uint64_t since) const {
  const Chunk* chunk = find(index);
  if (!chunk) return nullptr;
  if (level > 0) return made(*chunk)->coarse[static_cast<std::size_t>(level - 1)];
  const std::uint64_t key = pack_index(index);
  const bool whole = since == 0 || !shown_.contains(key);
  if (whole)
    if (auto kept = fine_.find(key)) return *kept;
  Bytes bytes = make_fine(*chunk, since);
  if (whole) fine_.keep(key, bytes, bytes->size());
  return bytes;
}

SavedSurface::Bytes SavedSurface::make_fine(const Chunk& chunk, std::uint64_t since) const {
  const SharedMesh mesh = mesh_of(chunk);
  MeshChunk fine = in_one_patch(chunk, mesh);
  const BlockIndex first = fine.patches.front().block;
  if (const auto shown = shown_.find(pack_index(chunk.index)); since > 0 && shown != shown_.end())
    for (const BlockIndex& block : shown->second)
      if (block != first) fine.patches.push_back({block, version_, std::make_shared<Mesh>(), 0});
  return std::make_shared<const std::string>(
      encode_chunk(fine, grid(), 0, since, made(chunk, mesh)->errors));
}

BlockErrors SavedSurface::errors() const {
  BlockErrors all;
  for (const Chunk& chunk : chunks_) {
    const BlockErrors own = made(chunk)->errors;
    all.insert(own.begin(), own.end());
  }
  return all;
}

void SavedSurface::for_each_patch(const Eigen::AlignedBox3f& box,
                                  const std::function<void(const SurfacePatch&)>& visit) const {
  for (const Chunk& chunk : chunks_) {
    if (!meets(box, chunk.index)) continue;
    visit(in_one_patch(chunk, mesh_of(chunk)).patches.front());
  }
}

}  // namespace ovimap
