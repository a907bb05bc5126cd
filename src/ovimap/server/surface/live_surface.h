// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>

#include "ovimap/server/surface/served_surface.h"

namespace ovimap {

/// The surface of a map that is being made, all of it in memory. It has level 0 alone: a coarse
/// surface of what still changes would cost more than it saves. One may write while many read.
class LiveSurface final : public ServedSurface {
 public:
  using ServedSurface::ServedSurface;

  /// Takes new patches of some blocks as the next version. Null meshes: the block has no surface.
  void update(std::vector<SurfacePatch> patches);

  /// All that clients may know of.
  ShownBlocks blocks() const;

  std::uint64_t version() const override;
  std::vector<ChunkListing> list(int level, std::uint64_t since = 0) const override;
  std::shared_ptr<const std::string> encoded(int level, const Eigen::Vector3i& index,
                                             std::uint64_t since = 0) const override;
  BlockErrors errors() const override;
  void for_each_patch(const Eigen::AlignedBox3f& box,
                      const std::function<void(const SurfacePatch&)>& visit) const override;

 private:
  using Chunks = std::vector<std::shared_ptr<const MeshChunk>>;  // ordered by index (z, y, x)
  Chunks chunks() const;
  std::shared_ptr<const MeshChunk> find(const Eigen::Vector3i& index) const;

  mutable std::mutex mutex_;
  Chunks chunks_;
  std::uint64_t version_ = 0;
};

}  // namespace ovimap
