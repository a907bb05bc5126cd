// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "ovimap/geometry/mesh.h"
#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

/// The surface that one block owns, complete in itself: vertices on a side it shares with another
/// block occur in both, at the same place to the bit. No normals.
struct MeshPatch {
  Mesh mesh;
  std::uint64_t version = 0;  ///< of the update that made it
};

/// The map's mesh, block by block, kept up to date by re-extracting what changed. Its cost is that
/// of the changed blocks, however large the map is.
class IncrementalMesh {
 public:
  /// Brings the patches up to date after an integration that visited the blocks `visited`
  /// (integrate's result). Labels change by merges too, anywhere: a patch shows those of its last
  /// update. Returns the slots of the blocks whose patches were made anew, ascending.
  std::vector<std::uint32_t> update(const VoxelMap& map, std::span<const std::uint32_t> visited);

  /// Null where the block owns no surface.
  const MeshPatch* patch(std::uint32_t slot) const {
    return slot < patches_.size() ? patches_[slot].get() : nullptr;
  }
  std::uint64_t version() const { return version_; }  ///< of the last update; 0: none yet

 private:
  std::vector<std::uint32_t> touched(const VoxelMap& map, std::span<const std::uint32_t> visited);

  std::vector<std::unique_ptr<MeshPatch>> patches_;  ///< by slot
  std::vector<std::uint64_t> touched_in_;            ///< by slot: the last update that met it
  std::uint64_t version_ = 0;
};

/// The patches of some blocks, in their order; empty where a block owns no surface.
std::vector<Mesh> extract_patches(const VoxelMap& map, std::span<const std::uint32_t> slots);

/// Calls `visit` with the patch of every block that owns surface, tile after tile, and lets the map
/// make room in between: for maps whose mesh, or whose blocks, are more than memory holds. `visit`
/// may change the patch.
void for_each_patch(const VoxelMap& map, const std::function<void(Mesh&)>& visit);

}  // namespace ovimap
