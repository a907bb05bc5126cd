// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <set>

#include "ovimap/io/map_file/map_file_access.h"
#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/io/map_tables/map_file_blocks.h"

namespace ovimap {

/// The voxels of a saved map, read from its file tile by tile when somebody asks for them, and
/// given up again: for those who need a part of a map, or walk over one that may be larger than
/// memory. The map must not be changed.
class SavedTiles : public BlockStore {
 public:
  /// `max_bytes`: of voxels that `trim` lets stay. Throws what OpenMap throws.
  SavedTiles(const std::filesystem::path& map, std::size_t max_bytes);

  /// Threads that ask for blocks of different tiles do not wait for each other. Throws Error for a
  /// tile that is not what was written.
  void load(const VoxelMap& map, std::uint32_t slot) override;
  void note_changes(const VoxelMap&, std::span<const std::uint32_t>) override {}
  /// Gives up all tiles when they are more than the bound.
  void trim(const VoxelMap& map) override;

 private:
  StoredTile read(std::uint64_t tile);

  const std::filesystem::path path_;
  const std::size_t max_bytes_;
  std::mutex reading_;  ///< guards `file_`
  OpenMap file_;
  std::mutex placing_;                 ///< guards what follows, and the map's places for blocks
  std::set<std::uint64_t> in_memory_;  ///< keys of tiles
};

/// A whole map but for its voxels, which are read when they are asked for; `max_bytes` of them stay
/// from one VoxelMap::trim to the next. Throws what load_map throws, except that damaged voxels
/// show when they are asked for.
MapDocument load_map_by_tiles(const std::filesystem::path& path, std::size_t max_bytes);

}  // namespace ovimap
