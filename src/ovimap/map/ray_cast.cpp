// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/ray_cast.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "ovimap/base/parallel.h"
#include "ovimap/map/label_slots.h"
#include "ovimap/map/surface_lookup.h"
#include "ovimap/map/tile_ranges.h"

namespace ovimap {

namespace {

constexpr std::size_t kRowsPerTask = 8;

/// Marches one ray after another; one per thread.
class RayMarcher {
 public:
  RayMarcher(const VoxelMap& map, const Eigen::Vector3f& origin)
      : map_(map),
        finder_(map),
        origin_(origin),
        unobserved_step_(map.config().voxel_size_m *
                         static_cast<float>(std::max(1, map.config().truncation_voxels - 2))),
        voxel_(map.config().voxel_size_m),
        inverse_voxel_(1.f / map.config().voxel_size_m),
        block_(map.config().block_size_m()),
        inverse_block_(1.f / map.config().block_size_m()) {}

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
      const VoxelRef ref = finder_.find(point);
      if (!ref) {
        last_distance = 0.f;
        range += leap(point, inverse);
        continue;
      }
      const VoxelBlock& block = map_.block(ref.block());
      if (block.weight[static_cast<std::size_t>(ref.voxel())] <= 0.f) {
        last_distance = 0.f;
        range += unobserved_step_;
        continue;
      }
      const float distance = map_.distance_m(block, ref.voxel());
      if (distance <= 0.f && last_distance > 0.f) {
        return refine(direction, last_range, last_distance, range, distance, ref);
      }
      last_distance = distance, last_range = range;
      range += std::max(std::fabs(distance), 0.5f * voxel_);
    }
    return {0.f, {}};
  }

 private:
  /// Narrows a crossing between two ranges by interpolated distances (false position).
  Hit refine(const Eigen::Vector3f& direction, float front, float front_distance, float back,
             float back_distance, VoxelRef fallback) {
    float crossing = front;
    for (int step = 0; step < kRefinements; ++step) {
      crossing = front + (back - front) * front_distance / (front_distance - back_distance);
      const std::optional<float> distance = interpolate(origin_ + direction * crossing);
      if (!distance || std::fabs(*distance) < kCloseEnough * voxel_) break;
      if (*distance > 0.f)
        front = crossing, front_distance = *distance;
      else
        back = crossing, back_distance = *distance;
    }
    const VoxelRef at = finder_.find(origin_ + direction * crossing);
    return {crossing, at ? at : fallback};
  }

  /// Trilinear distance, metres; that of the nearest voxel when one of the eight was never
  /// observed; nullopt when that is so itself.
  std::optional<float> interpolate(const Eigen::Vector3f& point) {
    const Eigen::Vector3f grid = point.array() * inverse_voxel_ - 0.5f;
    const Eigen::Vector3i low = floor_to_int(grid);
    const Eigen::Vector3f share = grid - low.cast<float>();
    const VoxelRef first = finder_.find_voxel(low);
    const bool one_block = first && (low.x() & 7) < 7 && (low.y() & 7) < 7 && (low.z() & 7) < 7;
    float distances[8];
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3i offset(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
      const VoxelRef ref = one_block
                               ? VoxelRef{first.value + static_cast<std::uint32_t>(voxel_offset(
                                                            offset.x(), offset.y(), offset.z()))}
                               : finder_.find_voxel(low + offset);
      if (!ref || map_.block(ref.block()).weight[static_cast<std::size_t>(ref.voxel())] <= 0.f)
        return nearest(point);
      const VoxelBlock& block = map_.block(ref.block());
      distances[corner] = map_.distance_m(block, ref.voxel());
    }
    for (int axis = 0, width = 1; axis < 3; ++axis, width *= 2)
      for (int i = 0; i < 8; i += 2 * width)
        distances[i] += share[axis] * (distances[i + width] - distances[i]);
    return distances[0];
  }

  std::optional<float> nearest(const Eigen::Vector3f& point) {
    const VoxelRef ref = finder_.find(point);
    if (!ref || map_.block(ref.block()).weight[static_cast<std::size_t>(ref.voxel())] <= 0.f)
      return std::nullopt;
    return map_.distance_m(map_.block(ref.block()), ref.voxel());
  }

  /// Distance along the ray to the far side of the empty block, or of the empty cube of blocks, at
  /// `point`.
  float leap(const Eigen::Vector3f& point, const Eigen::Vector3f& inverse_direction) {
    const BlockIndex index = block_at(point, inverse_block_);
    const BlockIndex region(index.x() >> 3, index.y() >> 3, index.z() >> 3);
    if (region != last_region_) {
      last_region_ = region;
      last_region_empty_ = !map_.region_occupied(index);
    }
    const bool empty_region = last_region_empty_;
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
  static constexpr float kCloseEnough = 0.05f;  // voxels
  const VoxelMap& map_;
  VoxelFinder finder_;
  Eigen::Vector3f origin_;
  float unobserved_step_;  ///< shorter than the band in front of a surface, so none is stepped over
  float voxel_, inverse_voxel_, block_, inverse_block_;
  BlockIndex last_region_ = BlockIndex::Constant(1 << 20);  // outside every map
  bool last_region_empty_ = true;
};

/// Fills `result` by rows; `known` may give a pixel's answer and spare the march.
template <class Known>
Projection cast(const VoxelMap& map, const PinholeCamera& camera, const Pose& world_from_camera,
                float max_range_m, const Known& known) {
  Projection result{DepthImage(camera.width, camera.height),
                    Image<Label>(camera.width, camera.height)};
  const Eigen::Matrix3f rotation = world_from_camera.linear().cast<float>();
  const Eigen::Vector3f origin = world_from_camera.translation().cast<float>();
  const TileRanges ranges(map, camera, world_from_camera, max_range_m);
  parallel_for_ranges(static_cast<std::size_t>(camera.height), kRowsPerTask,
                      [&](std::size_t begin, std::size_t end) {
                        RayMarcher marcher(map, origin);
                        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                          for (int x = 0; x < camera.width; ++x) {
                            const TileRanges::Range& range = ranges.at_pixel(x, y);
                            if (range.near_m > range.far_m || known(x, y, result)) continue;
                            const Eigen::Vector3f ray =
                                camera.unproject(static_cast<float>(x), static_cast<float>(y), 1.f);
                            const float stretch = ray.norm();
                            const RayMarcher::Hit hit =
                                marcher.march(rotation * ray / stretch, range.near_m * stretch,
                                              std::min(range.far_m * stretch, max_range_m));
                            result.depth.at(x, y) = hit.range_m / stretch;
                            result.labels.at(x, y) = map.label(hit.voxel);
                          }
                        }
                      });
  return result;
}

}  // namespace

Projection cast_rays(const VoxelMap& map, const PinholeCamera& camera,
                     const Pose& world_from_camera, float max_range_m) {
  return cast(map, camera, world_from_camera, max_range_m,
              [](int, int, Projection&) { return false; });
}

Projection cast_rays_with_depth(const VoxelMap& map, const DepthImage& sensor_depth,
                                const Image<VoxelRef>& surface, const PinholeCamera& camera,
                                const Pose& world_from_camera, float max_range_m) {
  return cast(map, camera, world_from_camera, max_range_m, [&](int x, int y, Projection& result) {
    const VoxelRef ref = surface.at(x, y);
    if (!ref) return false;
    result.depth.at(x, y) = sensor_depth.at(x, y);
    result.labels.at(x, y) = map.label(ref);
    return true;
  });
}

}  // namespace ovimap
