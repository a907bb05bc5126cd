// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/rays/ray_cast.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/map/rays/pixel_rays.h"
#include "ovimap/map/rays/surface_lookup.h"
#include "ovimap/map/voxels/tile_ranges.h"

namespace ovimap {

namespace {

constexpr std::size_t kCastRowsPerTask = 8;

/// Marches one ray after another; one per thread.
class RayMarcher {
 public:
  RayMarcher(const VoxelMap& map, const Eigen::Vector3f& origin)
      : finder_(map),
        origin_(origin),
        unobserved_step_(map.config().voxel_size_m *
                         static_cast<float>(std::max(1, map.config().truncation_voxels - 2))),
        voxel_(map.config().voxel_size_m),
        inverse_voxel_(1.f / map.config().voxel_size_m),
        block_(map.config().block_size_m()) {}

  struct Hit {
    float range_m;
    VoxelRef voxel;
  };

  /// First crossing from positive to negative distance along the unit `direction`, between two
  /// ranges; range 0 when there is none.
  Hit march(const Eigen::Vector3f& direction, float min_range_m, float max_range_m) {
    const Eigen::Vector3f inverse = direction.cwiseInverse();
    float last_distance = 0.f, last_range = 0.f;  // last_distance > 0: in front of a surface
    for (float range = min_range_m; range < max_range_m;) {
      const Eigen::Vector3f point = origin_ + direction * range;
      if (!finder_.seek(point)) {
        last_distance = 0.f;
        range += leap(point, inverse);
        continue;
      }
      if (!finder_.observed()) {
        last_distance = 0.f;
        range += unobserved_step_;
        continue;
      }
      const float distance = finder_.distance_m();
      if (distance <= 0.f && last_distance > 0.f)
        return refine(direction, last_range, last_distance, range, distance);
      last_distance = distance, last_range = range;
      range += std::max(std::fabs(distance), 0.5f * voxel_);
    }
    return {0.f, {}};
  }

 private:
  /// Distance to the surface at a place of a ray, metres, and how it changes along the ray.
  struct Sample {
    float distance_m, slope;
  };

  /// The crossing between two ranges: first by the distances of the voxels there, then by
  /// interpolated distances and slopes (Newton). Voxels' own distances are off by up to half a
  /// voxel, so it may lie a little outside. Within one cell a step needs no second look.
  Hit refine(const Eigen::Vector3f& direction, float front, float front_distance, float back,
             float back_distance) {
    const VoxelRef behind = finder_.ref();
    float crossing = front + (back - front) * front_distance / (front_distance - back_distance);
    for (int step = 0; step < kRefinements; ++step) {
      const std::optional<Sample> at = interpolate(origin_ + direction * crossing, direction);
      if (!at || at->slope >= 0.f) break;
      const float moved = std::clamp(-at->distance_m / at->slope, -voxel_, voxel_);
      crossing += moved;
      if (std::fabs(moved) < kCloseEnough * voxel_) break;
    }
    const bool found = finder_.seek(Eigen::Vector3f(origin_ + direction * crossing));
    return {crossing, found ? finder_.ref() : behind};
  }

  /// Trilinear; nullopt when one of the eight voxels was never observed.
  std::optional<Sample> interpolate(const Eigen::Vector3f& point,
                                    const Eigen::Vector3f& direction) {
    const Eigen::Vector3f grid = point.array() * inverse_voxel_ - 0.5f;
    const Eigen::Vector3i low = floor_to_int(grid);
    const Eigen::Vector3f share = grid - low.cast<float>();
    float value[8], slope[8] = {};  // of corners, edges, faces, then of the point
    if (!read_cell(low, value)) return std::nullopt;
    for (int axis = 0, width = 1; axis < 3; ++axis, width *= 2) {
      const float moving = direction[axis] * inverse_voxel_;
      for (int i = 0; i < 8; i += 2 * width) {
        const float rise = value[i + width] - value[i];
        slope[i] += share[axis] * (slope[i + width] - slope[i]) + moving * rise;
        value[i] += share[axis] * rise;
      }
    }
    return Sample{value[0], slope[0]};
  }

  /// Distances of the eight voxels from `low` upwards; false when one was never observed.
  bool read_cell(const Eigen::Vector3i& low, float* corners) {
    if ((low.x() & 7) < 7 && (low.y() & 7) < 7 && (low.z() & 7) < 7) {  // all in one block
      if (!finder_.seek(low)) return false;
      bool observed = true;
      for (int corner = 0; corner < 8; ++corner)
        observed &= finder_.read(voxel_offset(corner & 1, corner >> 1 & 1, corner >> 2 & 1),
                                 corners[corner]);
      return observed;
    }
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3i offset(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
      if (!finder_.seek(Eigen::Vector3i(low + offset)) || !finder_.read(0, corners[corner]))
        return false;
    }
    return true;
  }

  /// Distance along the ray to the far side of the empty block, or of the empty cube of blocks, at
  /// `point`, where the finder is.
  float leap(const Eigen::Vector3f& point, const Eigen::Vector3f& inverse_direction) const {
    const BlockIndex& index = finder_.block_index();
    const bool empty_region = !finder_.in_region();
    const float side = empty_region ? block_ * kRegionBlocks : block_;
    float exit = std::numeric_limits<float>::max();
    for (int axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(inverse_direction[axis])) continue;
      const int cell = empty_region ? index[axis] >> 3 : index[axis];
      const float wall = static_cast<float>(cell + (inverse_direction[axis] > 0.f ? 1 : 0)) * side;
      exit = std::min(exit, (wall - point[axis]) * inverse_direction[axis]);
    }
    return std::max(exit, 0.f) + 0.01f * voxel_;  // a hair beyond the wall
  }

  static constexpr int kRefinements = 3;
  static constexpr float kCloseEnough = 0.5f;  ///< voxels; a shorter step of Newton is the last
  VoxelFinder finder_;
  Eigen::Vector3f origin_;
  float unobserved_step_;  ///< shorter than the band in front of a surface, so none is stepped over
  float voxel_, inverse_voxel_, block_;
};

/// What all rays of a projection have in common.
struct View {
  View(const VoxelMap& voxel_map, const PinholeCamera& camera, const Pose& world_from_camera,
       float max_range)
      : map(voxel_map),
        rays(camera, world_from_camera.linear().cast<float>()),
        origin(world_from_camera.translation().cast<float>()),
        max_range_m(max_range),
        ranges(voxel_map, camera, world_from_camera, max_range) {}

  const VoxelMap& map;
  PixelRays rays;
  Eigen::Vector3f origin;
  float max_range_m;
  TileRanges ranges;
};

/// Casts the rays of a row's pixels that `depth` has no answer for yet.
OVIMAP_VECTORIZE void cast_row(const View& view, int y, int width, RayMarcher& marcher,
                               float* depth, Label* labels) {
  for (int x = 0; x < width; ++x) {
    const TileRanges::Range& range = view.ranges.at_pixel(x, y);
    if (depth[x] > 0.f || range.near_m > range.far_m) continue;
    const Eigen::Vector3f ray = view.rays.at(x, y);
    const float stretch = ray.norm();
    const RayMarcher::Hit hit = marcher.march(ray / stretch, range.near_m * stretch,
                                              std::min(range.far_m * stretch, view.max_range_m));
    depth[x] = hit.range_m / stretch;
    labels[x] = view.map.label(hit.voxel);
  }
}

/// Fills what is still empty in `result`.
void cast(const View& view, Projection& result) {
  parallel_for_ranges(static_cast<std::size_t>(result.depth.height()), kCastRowsPerTask,
                      [&](std::size_t begin, std::size_t end) {
                        RayMarcher marcher(view.map, view.origin);
                        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                          cast_row(view, y, result.depth.width(), marcher, result.depth.row(y),
                                   result.labels.row(y));
                      });
}

}  // namespace

Projection cast_rays(const VoxelMap& map, const PinholeCamera& camera,
                     const Pose& world_from_camera, float max_range_m) {
  Projection result{DepthImage(camera.width, camera.height),
                    Image<Label>(camera.width, camera.height)};
  cast(View(map, camera, world_from_camera, max_range_m), result);
  return result;
}

Projection cast_rays_with_depth(const VoxelMap& map, const DepthImage& sensor_depth,
                                const Image<VoxelRef>& surface, const PinholeCamera& camera,
                                const Pose& world_from_camera, float max_range_m) {
  Projection result{DepthImage(camera.width, camera.height),
                    Image<Label>(camera.width, camera.height)};
  parallel_for(surface.size(), kCastRowsPerTask * 640, [&](std::size_t i) {
    if (!surface[i]) return;
    result.depth[i] = sensor_depth[i];
    result.labels[i] = map.label(surface[i]);
  });
  cast(View(map, camera, world_from_camera, max_range_m), result);
  return result;
}

}  // namespace ovimap
