// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/rays/surface_lookup.h"

#include <cmath>

#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/map/rays/pixel_rays.h"

namespace ovimap {

namespace {

constexpr std::size_t kLookupRowsPerTask = 16;

/// The voxels that hold the points of one image row, in global voxel coordinates.
struct RowVoxels {
  explicit RowVoxels(int width) : x(static_cast<std::size_t>(width)), y(x.size()), z(x.size()) {}
  std::vector<int> x, y, z;
};

inline int floor_of(float value) {
  const int truncated = static_cast<int>(value);
  return truncated - (static_cast<float>(truncated) > value);
}

OVIMAP_VECTORIZE void find_row_voxels(const float* depth, const PixelRays::Row& rays,
                                      const Eigen::Vector3f& origin, float inverse_voxel_size,
                                      int width, RowVoxels& voxels) {
  const float ox = origin.x(), oy = origin.y(), oz = origin.z();
  const float rx = rays.part.x(), ry = rays.part.y(), rz = rays.part.z();
  int *x = voxels.x.data(), *y = voxels.y.data(), *z = voxels.z.data();
  OVIMAP_NO_OVERLAP  // the arrays never overlap
      for (int i = 0; i < width; ++i) {
    x[i] = floor_of((ox + (rays.column_x[i] + rx) * depth[i]) * inverse_voxel_size);
    y[i] = floor_of((oy + (rays.column_y[i] + ry) * depth[i]) * inverse_voxel_size);
    z[i] = floor_of((oz + (rays.column_z[i] + rz) * depth[i]) * inverse_voxel_size);
  }
}

/// `voxel` when the surface runs through it, else the one that its distance points to along the
/// ray, if that one is on the surface.
template <class Point>
VoxelRef find_surface(VoxelFinder& finder, const Eigen::Vector3i& voxel, const Point& point_at,
                      float voxel_size_m) {
  if (!finder.seek(voxel) || !finder.observed()) return {};
  const float distance_m = finder.distance_m();
  if (std::fabs(distance_m) < voxel_size_m) return finder.ref();
  if (!finder.seek(point_at(distance_m)) || !finder.observed()) return {};
  return std::fabs(finder.distance_m()) < voxel_size_m ? finder.ref() : VoxelRef{};
}

}  // namespace

Image<VoxelRef> surface_voxels(const VoxelMap& map, const DepthImage& depth,
                               const PinholeCamera& camera, const Pose& world_from_camera) {
  const int width = depth.width();
  Image<VoxelRef> result(width, depth.height());
  const PixelRays rays(camera, world_from_camera.linear().cast<float>());
  const Eigen::Vector3f origin = world_from_camera.translation().cast<float>();
  const float inverse_voxel_size = 1.f / map.config().voxel_size_m;
  parallel_for_ranges(static_cast<std::size_t>(depth.height()), kLookupRowsPerTask,
                      [&](std::size_t begin, std::size_t end) {
                        VoxelFinder finder(map);
                        RowVoxels voxels(width);
                        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                          const float* z = depth.row(y);
                          find_row_voxels(z, rays.row(y), origin, inverse_voxel_size, width,
                                          voxels);
                          VoxelRef* found = result.row(y);
                          for (int x = 0; x < width; ++x) {
                            if (z[x] <= 0.f) continue;
                            const auto i = static_cast<std::size_t>(x);
                            const auto along_ray = [&](float distance_m) -> Eigen::Vector3f {
                              const Eigen::Vector3f ray = rays.at(x, y);
                              return origin + ray * (z[x] + distance_m / ray.norm());
                            };
                            found[x] = find_surface(finder, {voxels.x[i], voxels.y[i], voxels.z[i]},
                                                    along_ray, map.config().voxel_size_m);
                          }
                        }
                      });
  return result;
}

}  // namespace ovimap
