// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "ovimap/server/surface/mesh_chunks.h"

namespace ovimap {

/// What a list of chunks says of one.
struct ChunkListing {
  Eigen::Vector3i index = Eigen::Vector3i::Zero();
  std::uint64_t version = 0;
  std::optional<ChunkTotals> totals;  ///< nothing as long as the chunk was not made
};

/// A map's surface as clients see it: in chunks, and at level 0 in all detail, at the others in
/// less, for pictures of what is far away and for slow machines. Thread-safe.
class ServedSurface {
 public:
  static constexpr int kLevels = 3;

  explicit ServedSurface(const ChunkGrid& grid) : grid_(grid) {}
  virtual ~ServedSurface() = default;
  const ChunkGrid& grid() const { return grid_; }

  /// Grows with every change; 0: there is no surface yet.
  virtual std::uint64_t version() const = 0;
  /// Chunks with a version above `since`, ordered by index (z, y, x).
  virtual std::vector<ChunkListing> list(int level, std::uint64_t since = 0) const = 0;
  /// A chunk as encode_chunk writes it, which is made if need be; null where there is none. Throws
  /// Error when the map it is made of cannot be read.
  virtual std::shared_ptr<const std::string> encoded(int level, const Eigen::Vector3i& index,
                                                     std::uint64_t since = 0) const = 0;
  /// How well the surface is known, of all blocks that tell it.
  virtual BlockErrors errors() const = 0;
  /// Calls `visit` with all patches of level 0 whose chunk meets `box`, one after another.
  virtual void for_each_patch(const Eigen::AlignedBox3f& box,
                              const std::function<void(const SurfacePatch&)>& visit) const = 0;

 protected:
  bool meets(const Eigen::AlignedBox3f& box, const Eigen::Vector3i& chunk) const {
    const Eigen::Vector3f corner = grid_.origin(chunk);
    return box.intersects(
        {corner, Eigen::Vector3f(corner + Eigen::Vector3f::Constant(grid_.edge_m()))});
  }

 private:
  const ChunkGrid grid_;
};

/// Of space, what for_each_patch takes for all of it.
inline Eigen::AlignedBox3f all_space() {
  constexpr float kFar = std::numeric_limits<float>::max();
  return {Eigen::Vector3f::Constant(-kFar), Eigen::Vector3f::Constant(kFar)};
}

}  // namespace ovimap
