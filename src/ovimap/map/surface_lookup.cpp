// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/surface_lookup.h"

#include <cmath>

#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

constexpr std::size_t kRowsPerTask = 16;

/// Surface voxel at the end of a ray, after at most one step along it.
VoxelRef surface_at(const VoxelMap& map, VoxelFinder& finder, Eigen::Vector3f point,
                    const Eigen::Vector3f& direction) {
  const float voxel_size = map.config().voxel_size_m;
  for (int attempt = 0; attempt < 2; ++attempt) {
    const VoxelRef ref = finder.find(point);
    if (!ref) return {};
    const VoxelBlock& block = map.block(ref.block());
    if (block.weight[static_cast<std::size_t>(ref.voxel())] <= 0.f) return {};
    const float distance = map.distance_m(block, ref.voxel());
    if (std::fabs(distance) < voxel_size) return ref;
    point += direction * distance;
  }
  return {};
}

}  // namespace

Image<VoxelRef> surface_voxels(const VoxelMap& map, const DepthImage& depth,
                               const PinholeCamera& camera, const Pose& world_from_camera) {
  Image<VoxelRef> result(depth.width(), depth.height());
  const Eigen::Matrix3f rotation = world_from_camera.linear().cast<float>();
  const Eigen::Vector3f origin = world_from_camera.translation().cast<float>();
  parallel_for_ranges(
      static_cast<std::size_t>(depth.height()), kRowsPerTask,
      [&](std::size_t begin, std::size_t end) {
        VoxelFinder finder(map);
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
          for (int x = 0; x < depth.width(); ++x) {
            const float z = depth.at(x, y);
            if (z <= 0.f) continue;
            const Eigen::Vector3f ray =
                rotation * camera.unproject(static_cast<float>(x), static_cast<float>(y), 1.f);
            result.at(x, y) = surface_at(map, finder, origin + ray * z, ray.normalized());
          }
        }
      });
  return result;
}

}  // namespace ovimap
