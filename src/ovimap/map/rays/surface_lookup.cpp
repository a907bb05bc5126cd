// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/rays/surface_lookup.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/map/rays/pixel_rays.h"
#include "ovimap/map/rays/voxel_lanes.h"

namespace ovimap {

namespace {

constexpr std::size_t kLookupRowsPerTask = 16;

/// One per thread.
class RowLookup {
 public:
  RowLookup(const VoxelMap& map, const PixelRays& rays, const Eigen::Vector3f& origin)
      : lanes_(map),
        finder_(map),
        rays_(rays),
        origin_(origin),
        voxel_(map.config().voxel_size_m) {}

  OVIMAP_VECTORIZE void look_up(const float* depth, int y, int width, VoxelRef* found) {
    const PixelRays::Row row = rays_.row(y);
    int x = 0;
    for (; x + kLanes <= width; x += kLanes) look_up_lanes(depth, row, x, y, found);
    if (x < width && width >= kLanes) look_up_lanes(depth, row, x = width - kLanes, y, found);
    for (; width < kLanes && x < width; ++x)
      if (depth[x] > 0.f) found[x] = look_up_pixel(x, y, depth[x]);
  }

 private:
  OVIMAP_INLINE void look_up_lanes(const float* depths, const PixelRays::Row& row, int x, int y,
                                   VoxelRef* found) {
    const Floats depth = load(depths + x);
    const auto along = [&](const float* columns, int axis) __attribute__((always_inline)) {
      return floor_of((origin_[axis] + (load(columns + x) + row.part[axis]) * depth) *
                      (1.f / voxel_));
    };
    const Ints wanted = depth > 0.f;
    const VoxelLanes::Voxels voxels = lanes_.seek(
        {along(row.column_x, 0), along(row.column_y, 1), along(row.column_z, 2)}, wanted);
    const auto [distance, observed] = lanes_.distances(voxels);
    const Ints on_surface = wanted & observed & (magnitude(distance) < voxel_);
    const Ints refs = on_surface ? voxels.slot * kBlockVoxels + voxels.offset : Ints{} - 1;
    static_assert(sizeof(VoxelRef) == sizeof(refs[0]) && VoxelRef{}.value + 1 == 0);
    std::memcpy(static_cast<void*>(found + x), &refs, sizeof(refs));
    if (const Ints off = wanted & observed & ~on_surface; any(off))
      for (int lane = 0; lane < kLanes; ++lane)
        if (off[lane]) found[x + lane] = look_up_moved(x + lane, y, depth[lane], distance[lane]);
  }

  VoxelRef look_up_pixel(int x, int y, float depth) {
    if (!finder_.seek(Eigen::Vector3f(origin_ + rays_.at(x, y) * depth)) || !finder_.observed())
      return {};
    const float distance_m = finder_.distance_m();
    return std::fabs(distance_m) < voxel_ ? finder_.ref() : look_up_moved(x, y, depth, distance_m);
  }

  /// The voxel that the distance of another points to along the ray, if that one is on the surface.
  VoxelRef look_up_moved(int x, int y, float depth, float distance_m) {
    const Eigen::Vector3f ray = rays_.at(x, y);
    const Eigen::Vector3f point = origin_ + ray * (depth + distance_m / ray.norm());
    if (!finder_.seek(point) || !finder_.observed()) return {};
    return std::fabs(finder_.distance_m()) < voxel_ ? finder_.ref() : VoxelRef{};
  }

  VoxelLanes lanes_;
  VoxelFinder finder_;
  const PixelRays& rays_;
  Eigen::Vector3f origin_;
  float voxel_;
};

}  // namespace

Image<VoxelRef> surface_voxels(const VoxelMap& map, const DepthImage& depth,
                               const PinholeCamera& camera, const Pose& world_from_camera) {
  Image<VoxelRef> result(depth.width(), depth.height());
  const PixelRays rays(camera, world_from_camera.linear().cast<float>());
  const Eigen::Vector3f origin = world_from_camera.translation().cast<float>();
  parallel_for_ranges(static_cast<std::size_t>(depth.height()), kLookupRowsPerTask,
                      [&](std::size_t begin, std::size_t end) {
                        RowLookup lookup(map, rays, origin);
                        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                          lookup.look_up(depth.row(y), y, depth.width(), result.row(y));
                      });
  return result;
}

}  // namespace ovimap
