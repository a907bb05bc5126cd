// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "ovimap/map/rays/ray_cast.h"
#include "ovimap/map/rays/surface_lookup.h"

namespace ovimap::plain {

/// Ray casting as plainly as possible: short equal steps, then bisection. What `cast_rays` must
/// agree with, and what bench/micro measures it against.
class RayCast {
 public:
  RayCast(const VoxelMap& map, const Pose& world_from_camera, float max_range_m)
      : map_(map),
        finder_(map),
        rotation_(world_from_camera.linear().cast<float>()),
        origin_(world_from_camera.translation().cast<float>()),
        voxel_m_(map.config().voxel_size_m),
        max_range_m_(max_range_m) {}

  /// Depth of the first surface along the ray of unit depth `direction` (camera frame), metres; 0
  /// when there is none. `label` is set to that of the voxel there.
  float depth(const Eigen::Vector3f& direction, Label& label) {
    const Eigen::Vector3f ray = rotation_ * direction;
    const float step = 0.25f * voxel_m_ / ray.norm();
    std::optional<float> before;
    for (int i = 1; static_cast<float>(i) * step * ray.norm() < max_range_m_; ++i) {
      const float back = static_cast<float>(i) * step;
      const std::optional<float> distance = distance_at(origin_ + ray * back);
      if (before && *before > 0.f && distance && *distance <= 0.f)
        return bisect(ray, back - step, back, label);
      before = distance;
    }
    return 0.f;
  }

 private:
  float bisect(const Eigen::Vector3f& ray, float front, float back, Label& label) {
    for (int i = 0; i < 20; ++i) {
      const float middle = 0.5f * (front + back);
      const std::optional<float> distance = distance_at(origin_ + ray * middle);
      (distance && *distance > 0.f ? front : back) = middle;
    }
    label = finder_.seek(Eigen::Vector3f(origin_ + ray * back)) ? map_.label(finder_.ref()) : 0;
    return back;
  }

  /// Trilinear; of the nearest voxel where one of the eight was never observed.
  std::optional<float> distance_at(const Eigen::Vector3f& point) {
    const Eigen::Vector3f grid = point / voxel_m_ - Eigen::Vector3f::Constant(0.5f);
    const Eigen::Vector3i low = floor_to_int(grid);
    const Eigen::Vector3f share = grid - low.cast<float>();
    float sum = 0.f;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3i offset(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
      if (!finder_.seek(Eigen::Vector3i(low + offset)) || !finder_.observed())
        return nearest(point);
      float weight = 1.f;
      for (int axis = 0; axis < 3; ++axis)
        weight *= offset[axis] == 1 ? share[axis] : 1.f - share[axis];
      sum += weight * finder_.distance_m();
    }
    return sum;
  }

  std::optional<float> nearest(const Eigen::Vector3f& point) {
    if (!finder_.seek(point) || !finder_.observed()) return std::nullopt;
    return finder_.distance_m();
  }

  const VoxelMap& map_;
  VoxelFinder finder_;
  Eigen::Matrix3f rotation_;
  Eigen::Vector3f origin_;
  float voxel_m_, max_range_m_;
};

/// All pixels of a camera.
inline Projection cast_rays(const VoxelMap& map, const PinholeCamera& camera,
                            const Pose& world_from_camera, float max_range_m) {
  RayCast rays(map, world_from_camera, max_range_m);
  Projection result{DepthImage(camera.width, camera.height),
                    Image<Label>(camera.width, camera.height)};
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
      result.depth.at(x, y) =
          rays.depth(camera.unproject(static_cast<float>(x), static_cast<float>(y), 1.f),
                     result.labels.at(x, y));
  return result;
}

}  // namespace ovimap::plain
