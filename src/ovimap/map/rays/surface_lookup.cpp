// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/rays/surface_lookup.h"

#include <algorithm>
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
      : lanes_(map), rays_(rays), origin_(origin), voxel_(map.config().voxel_size_m) {}

  OVIMAP_VECTORIZE void look_up(const float* depth, int y, int width, VoxelRef* found) {
    const PixelRays::Row row = rays_.row(y);
    int x = 0;
    for (; x + kLanes <= width; x += kLanes) {
      const Ints refs = look_up(row, x, load(depth + x));
      std::memcpy(static_cast<void*>(found + x), &refs, sizeof(refs));
    }
    if (x == width) return;
    float last[kLanes] = {};  // where there is no pixel there is no depth
    std::copy(depth + x, depth + width, last);
    const Ints refs = look_up(row, x, load(last));
    std::memcpy(static_cast<void*>(found + x), &refs,
                static_cast<std::size_t>(width - x) * sizeof(VoxelRef));
  }

 private:
  struct Voxels {
    Ints refs;  ///< as VoxelRef's
    Ints off;   ///< mask of those that were observed and lie off the surface
    Floats distance_m;
  };
  struct Rays {
    Floats x, y, z;
  };

  /// The voxels of points, and where these lie off the surface, those that their distance points to
  /// along the ray, if they are on it.
  OVIMAP_INLINE Ints look_up(const PixelRays::Row& row, int x, Floats depth) {
    const Rays rays{load(row.column_x + x) + row.part.x(), load(row.column_y + x) + row.part.y(),
                    load(row.column_z + x) + row.part.z()};
    const Voxels there = voxels_at(rays, depth, depth > 0.f);
    if (!any(there.off)) return there.refs;
    const Floats length = square_root(rays.x * rays.x + rays.y * rays.y + rays.z * rays.z);
    const Voxels moved = voxels_at(rays, depth + there.distance_m / length, there.off);
    return there.off ? moved.refs : there.refs;
  }

  OVIMAP_INLINE Voxels voxels_at(const Rays& rays, Floats depth, Ints wanted) {
    const auto along = [&](Floats ray, int axis) __attribute__((always_inline)) {
      return floor_of((origin_[axis] + ray * depth) * (1.f / voxel_));
    };
    const VoxelLanes::Voxels voxels =
        lanes_.seek({along(rays.x, 0), along(rays.y, 1), along(rays.z, 2)}, wanted);
    const auto [distance, observed] = lanes_.distances(voxels);
    const Ints on_surface = wanted & observed & (magnitude(distance) < voxel_);
    static_assert(sizeof(VoxelRef) == sizeof(on_surface[0]) && VoxelRef{}.value + 1 == 0);
    return {on_surface ? voxels.slot * kBlockVoxels + voxels.offset : Ints{} - 1,
            wanted & observed & ~on_surface, distance};
  }

  VoxelLanes lanes_;
  const PixelRays& rays_;
  Eigen::Vector3f origin_;
  float voxel_;
};

}  // namespace

Image<VoxelRef> surface_voxels(const VoxelMap& map, const DepthImage& depth,
                               const PinholeCamera& camera, const Pose& world_from_camera) {
  Image<VoxelRef> result = Image<VoxelRef>::unset(depth.width(), depth.height());
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
