// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ovimap/map/fusion/block_update.h"
#include "ovimap/map/fusion/free_space.h"

namespace ovimap::plain {

/// As free_depth, pixel by pixel.
inline Image<float> free_depth(const VoxelMapConfig& map, const Observation& seen,
                               const FreeSpaceConfig& config) {
  const int width = seen.depth.width(), height = seen.depth.height(), side = config.guard_px;
  Image<float> result(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float least = std::numeric_limits<float>::max();
      int pixels = 0, holes = 0;
      for (int v = std::max(0, (y / side - 1) * side); v < std::min(height, (y / side + 2) * side);
           ++v)
        for (int u = std::max(0, (x / side - 1) * side); u < std::min(width, (x / side + 2) * side);
             ++u) {
          const float depth = seen.depth.at(u, v),
                      fitted = seen.plane_slope ? seen.plane_slope->at(u, v) : 0.f,
                      slope = fitted > 0.f ? fitted : config.unknown_slope;
          const bool hole = depth <= 0.f || slope < config.least_slope;
          ++pixels;
          holes += hole;
          if (!hole)
            least =
                std::min(least, depth - std::max(config.margin_voxels * map.voxel_size_m / slope,
                                                 config.sigmas * seen.sigma_m->at(u, v)));
        }
      if (static_cast<float>(holes) <= config.holes * static_cast<float>(pixels))
        result.at(x, y) = std::max(least, 0.f);
    }
  return result;
}

/// The pixel that shows a point given in camera coordinates; -1: none.
inline int pixel_of(const PinholeCamera& camera, const Eigen::Vector3f& point) {
  const float inverse = 1.f / std::max(point.z(), 1e-6f);
  const float u = camera.fx * (point.x() * inverse) + (camera.cx + 0.5f),
              v = camera.fy * (point.y() * inverse) + (camera.cy + 0.5f);
  if (point.z() <= 1e-3f || u < 0.f || v < 0.f || u >= static_cast<float>(camera.width) ||
      v >= static_cast<float>(camera.height))
    return -1;
  return static_cast<int>(v) * camera.width + static_cast<int>(u);
}

inline void doubt(VoxelBlock& block, std::size_t voxel, int frames) {
  block.doubts.resize(kBlockVoxels);
  if (++block.doubts[voxel] >= frames) block.forget(voxel);
}

/// As clear_free_space, over every voxel of the map and without asking what the frame confirms.
inline void clear_free_space(VoxelMap& map, const Observation& seen,
                             const FreeSpaceConfig& config) {
  const Image<float> free_m = plain::free_depth(map.config(), seen, config);
  const FusionView view(map.config(), seen);
  const float surface = view.to_tsdf / view.voxels_per_m;
  for (std::uint32_t slot = 0; slot < map.block_count(); ++slot) {
    VoxelBlock& block = map.writable_block(slot);
    const Eigen::Vector3f origin = view.block_origin(block.index);
    for (std::size_t v = 0; v < kBlockVoxels; ++v) {
      const Eigen::Vector3f start = origin +
                                    view.voxel_steps.col(1) * static_cast<float>(v >> 3 & 7) +
                                    view.voxel_steps.col(2) * static_cast<float>(v >> 6);
      const Eigen::Vector3f point = start + view.voxel_steps.col(0) * static_cast<float>(v & 7);
      const int pixel = pixel_of(seen.camera, point);
      if (pixel >= 0 && block.weight[v] > 0.f && block.tsdf[v] < surface &&
          point.z() < free_m[static_cast<std::size_t>(pixel)])
        doubt(block, v, config.frames);
    }
  }
}

}  // namespace ovimap::plain
