// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/rays/ray_cast.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/map/rays/pixel_rays.h"
#include "ovimap/map/rays/surface_lookup.h"
#include "ovimap/map/rays/voxel_lanes.h"
#include "ovimap/map/voxels/tile_ranges.h"

namespace ovimap {

namespace {

constexpr std::size_t kCastRowsPerTask = 8;

/// Marches eight rays at once, each at its own pace; one per thread.
class RayMarcher {
 public:
  RayMarcher(const VoxelMap& map, const Eigen::Vector3f& origin)
      : voxels_(map),
        origin_(origin),
        unobserved_step_(map.config().voxel_size_m *
                         static_cast<float>(map.config().truncation_voxels + 1)),
        voxel_(map.config().voxel_size_m),
        inverse_voxel_(1.f / map.config().voxel_size_m) {}

  /// Unit directions, and between which ranges to look, metres.
  struct Rays {
    Floats x, y, z, near_m, far_m;
  };
  struct Hits {
    Floats range_m;     ///< 0 where there is none
    Ints slot, offset;  ///< of the voxel there
  };

  /// First crossings from positive to negative distance.
  OVIMAP_INLINE Hits march(const Rays& rays) {
    const Inverse inverse(rays);
    Bracket bracket{};
    Floats range = rays.near_m, last_range = range;
    Floats last_distance = {};  // > 0: in front of a surface
    Ints blind = {};            // the last voxel was never observed
    Floats careful_to = {};     // so far a step over such voxels was too long
    for (Ints active = range < rays.far_m; any(active); active &= range < rays.far_m) {
      const Points at = points(rays, range);
      const VoxelLanes::Coordinates coordinates = coordinates_of(at);
      const Voxels voxels = voxels_.seek(coordinates, active);
      const auto [distance, observed] = voxels_.distances(voxels);
      const Ints behind = active & observed & (distance <= 0.f);
      const Ints hit = behind & (last_distance > 0.f);
      if (any(hit)) {
        bracket.take(hit, {last_range, last_distance, range, distance, hit, voxels});
        active &= ~hit;
      }
      const Ints empty = voxels.slot < 0, too_far = behind & blind & (range > careful_to);
      Floats step = range < careful_to ? broadcast(voxel_) : broadcast(unobserved_step_);
      step = observed ? larger(magnitude(distance), broadcast(0.5f * voxel_)) : step;
      if (any(empty & active))
        step = empty ? leap(at, coordinates, voxels.empty_bits, rays, inverse) : step;
      step = too_far ? last_range + voxel_ - range : step;  // once more, voxel by voxel
      careful_to = too_far ? range : careful_to;
      blind = ~observed & ~empty;
      last_range = range, last_distance = distance;
      range = active ? range + step : range;
    }
    return any(bracket.found) ? refine(rays, bracket) : Hits{};
  }

 private:
  using Voxels = VoxelLanes::Voxels;
  struct Points {
    Floats x, y, z;
  };
  /// Of directions; 0 where rays run along a wall of blocks.
  struct Inverse {
    explicit OVIMAP_INLINE Inverse(const Rays& rays)
        : x(inverse_of(rays.x)), y(inverse_of(rays.y)), z(inverse_of(rays.z)) {}
    static OVIMAP_INLINE Floats inverse_of(Floats values) {
      return magnitude(values) > 1e-9f ? 1.f / values : Floats{};
    }
    Floats x, y, z;
  };
  /// Between which ranges a ray meets the surface, and the voxels' distances there.
  struct Bracket {
    Floats front, front_distance, back, back_distance;
    Ints found;
    Voxels behind;

    OVIMAP_INLINE void take(Ints hit, const Bracket& other) {
      front = hit ? other.front : front;
      front_distance = hit ? other.front_distance : front_distance;
      back = hit ? other.back : back;
      back_distance = hit ? other.back_distance : back_distance;
      found |= hit;
      behind.slot = hit ? other.behind.slot : behind.slot;
      behind.offset = hit ? other.behind.offset : behind.offset;
    }
  };
  /// Distance to the surface at a place of a ray, metres, and how it changes along the ray.
  struct Sample {
    Floats distance_m, slope;
    Ints known;
  };

  OVIMAP_INLINE Points points(const Rays& rays, Floats range) const {
    return {origin_.x() + rays.x * range, origin_.y() + rays.y * range,
            origin_.z() + rays.z * range};
  }
  OVIMAP_INLINE VoxelLanes::Coordinates coordinates_of(const Points& at) const {
    return {floor_of(at.x * inverse_voxel_), floor_of(at.y * inverse_voxel_),
            floor_of(at.z * inverse_voxel_)};
  }

  /// The crossing between two ranges: first by the distances of the voxels there, then by
  /// interpolated distances and slopes (Newton). Voxels' own distances are off by up to half a
  /// voxel, so it may lie a little outside. Within one cell a step needs no second look.
  OVIMAP_INLINE Hits refine(const Rays& rays, const Bracket& bracket) {
    Floats crossing =
        bracket.found ? bracket.front + (bracket.back - bracket.front) * bracket.front_distance /
                                            (bracket.front_distance - bracket.back_distance)
                      : Floats{};
    Ints moving = bracket.found;
    for (int step = 0; step < kRefinements && any(moving); ++step) {
      const Sample at = interpolate(rays, crossing, moving);
      moving &= at.known & (at.slope < 0.f);
      const Floats moved =
          smaller(larger(-at.distance_m / at.slope, broadcast(-voxel_)), broadcast(voxel_));
      crossing = moving ? crossing + moved : crossing;
      moving &= magnitude(moved) >= kCloseEnough * voxel_;
    }
    const Voxels there = voxels_.seek(coordinates_of(points(rays, crossing)), bracket.found);
    const Ints nowhere = there.slot < 0;
    return {crossing, nowhere ? bracket.behind.slot : there.slot,
            nowhere ? bracket.behind.offset : there.offset};
  }

  /// Trilinear.
  OVIMAP_INLINE Sample interpolate(const Rays& rays, Floats range, Ints wanted) {
    const Points at = points(rays, range);
    const Floats grid[3] = {at.x * inverse_voxel_ - 0.5f, at.y * inverse_voxel_ - 0.5f,
                            at.z * inverse_voxel_ - 0.5f};
    const VoxelLanes::Coordinates low{floor_of(grid[0]), floor_of(grid[1]), floor_of(grid[2])};
    const Floats share[3] = {grid[0] - __builtin_convertvector(low.x, Floats),
                             grid[1] - __builtin_convertvector(low.y, Floats),
                             grid[2] - __builtin_convertvector(low.z, Floats)};
    const Floats direction[3] = {rays.x, rays.y, rays.z};
    Floats value[8], slope[8] = {};  // of corners, edges, faces, then of the point
    const Ints known = voxels_.read_cells(low, wanted, value);
    for (int axis = 0, width = 1; axis < 3; ++axis, width *= 2) {
      const Floats moving = direction[axis] * inverse_voxel_;
      for (int i = 0; i < 8; i += 2 * width) {
        const Floats rise = value[i + width] - value[i];
        slope[i] += share[axis] * (slope[i + width] - slope[i]) + moving * rise;
        value[i] += share[axis] * rise;
      }
    }
    return {value[0] * voxels_.metres_per_unit(), slope[0] * voxels_.metres_per_unit(), known};
  }

  /// Distances along the rays to the far side of the empty block, or of the empty cube of blocks.
  OVIMAP_INLINE Floats leap(const Points& at, const VoxelLanes::Coordinates& voxel, Ints empty_bits,
                            const Rays& rays, const Inverse& inverse) const {
    const Floats side = __builtin_convertvector((Ints{} + 1) << empty_bits, Floats) * voxel_;
    Floats exit = broadcast(std::numeric_limits<float>::max());
    const auto meet = [&](Floats place, Ints coordinate, Floats direction, Floats inverse_direction)
        __attribute__((always_inline)) {
      const Ints cell = coordinate >> empty_bits;
      const Ints beyond = cell - (direction > 0.f);  // a mask is -1
      const Floats away =
          (__builtin_convertvector(beyond, Floats) * side - place) * inverse_direction;
      exit = inverse_direction != 0.f ? smaller(exit, away) : exit;
    };
    meet(at.x, voxel.x, rays.x, inverse.x);
    meet(at.y, voxel.y, rays.y, inverse.y);
    meet(at.z, voxel.z, rays.z, inverse.z);
    return larger(exit, Floats{}) + 0.01f * voxel_;  // a hair beyond the wall
  }

  static constexpr int kRefinements = 3;
  static constexpr float kCloseEnough = 0.5f;  ///< voxels; a shorter step of Newton is the last
  VoxelLanes voxels_;
  Eigen::Vector3f origin_;
  /// Shorter than the band around a surface. Where it leads over the half in front, a ray goes
  /// back.
  float unobserved_step_;
  float voxel_, inverse_voxel_;
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

/// Rays of pixels of one row, gathered until there are as many as are marched together.
struct RayBatch {
  int count = 0;
  int column[kLanes] = {};
  float stretch[kLanes] = {};  ///< how long the ray of unit depth is
  float x[kLanes] = {}, y[kLanes] = {}, z[kLanes] = {}, near_m[kLanes] = {}, far_m[kLanes] = {};

  OVIMAP_INLINE void add(int pixel, const Eigen::Vector3f& ray, const TileRanges::Range& depths,
                         float max_range_m) {
    const float length = ray.norm();
    column[count] = pixel, stretch[count] = length;
    x[count] = ray.x() / length, y[count] = ray.y() / length, z[count] = ray.z() / length;
    near_m[count] = depths.near_m * length;
    far_m[count] = std::min(depths.far_m * length, max_range_m);
    ++count;
  }
  /// Lanes that no ray was added to end where they begin.
  OVIMAP_INLINE RayMarcher::Rays rays() {
    for (int i = count; i < kLanes; ++i) near_m[i] = far_m[i] = 0.f;
    return {load(x), load(y), load(z), load(near_m), load(far_m)};
  }
};

/// Casts the rays of a row's pixels that `depth` has no answer for yet.
OVIMAP_VECTORIZE void cast_row(const View& view, int y, int width, RayMarcher& marcher,
                               float* depth, Label* labels) {
  RayBatch batch;
  for (int x = 0; x < width; ++x) {
    const TileRanges::Range& range = view.ranges.at_pixel(x, y);
    if (depth[x] <= 0.f && range.near_m <= range.far_m)
      batch.add(x, view.rays.at(x, y), range, view.max_range_m);
    if (batch.count < kLanes && (x + 1 < width || batch.count == 0)) continue;
    const RayMarcher::Hits hits = marcher.march(batch.rays());
    for (int i = 0; i < batch.count; ++i) {
      const int column = batch.column[i];
      depth[column] = hits.range_m[i] / batch.stretch[i];
      labels[column] = hits.range_m[i] > 0.f
                           ? view.map.label(VoxelRef::of(static_cast<std::uint32_t>(hits.slot[i]),
                                                         hits.offset[i]))
                           : kNoLabel;
    }
    batch.count = 0;
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
  Projection result{DepthImage::unset(camera.width, camera.height),
                    Image<Label>::unset(camera.width, camera.height)};
  parallel_for_ranges(surface.size(), kCastRowsPerTask * 640,
                      [&](std::size_t begin, std::size_t end) {
                        LabelReader labels(map);
                        for (std::size_t i = begin; i < end; ++i) {
                          result.depth[i] = surface[i] ? sensor_depth[i] : 0.f;
                          result.labels[i] = labels.at(surface[i]);
                        }
                      });
  cast(View(map, camera, world_from_camera, max_range_m), result);
  return result;
}

}  // namespace ovimap
