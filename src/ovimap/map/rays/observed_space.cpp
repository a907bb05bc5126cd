// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/rays/observed_space.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/config.h"
#include "ovimap/map/rays/ray_cast.h"

namespace ovimap {

void list_fields(ObservedSpaceConfig& config, ConfigFields& fields) {
  fields.add("width_px", config.width_px, 8, 4096, "width of the images that stand for frames");
  fields.add("max_views", config.max_views, 1, 1000000, "frames looked at, evenly spread");
  fields.add("max_range_m", config.max_range_m, 0.1f, 1000.f, "nothing further counts as seen");
  fields.add("margin_m", config.margin_m, 0.f, 10.f,
             "a point is seen through when the surface is further behind it, metres");
  fields.add("share", config.share, 0.f, 1.f, "the same as a share of the surface's distance");
}

ObservedSpace::ObservedSpace(const VoxelMap& map, const PinholeCamera& camera,
                             std::span<const Pose> world_from_camera,
                             const ObservedSpaceConfig& config)
    : config_(config) {
  if (!camera.valid() || world_from_camera.empty()) return;
  const int width = std::min(config.width_px, camera.width);
  camera_ = camera.scaled_to(width, std::max(1, camera.height * width / camera.width));
  const std::size_t frames = world_from_camera.size(),
                    count = std::min(frames, static_cast<std::size_t>(config.max_views));
  views_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Pose& pose = world_from_camera[(2 * i + 1) * frames / (2 * count)];
    views_[i].camera_from_world = pose.inverse().cast<float>();
    views_[i].depth = cast_rays(map, camera_, pose, config.max_range_m).depth;
    map.trim();
  }
}

int ObservedSpace::seen_through(const Eigen::Vector3f& point_in_world, int enough) const {
  int count = 0;
  for (const View& view : views_) {
    count += sees_through(view, point_in_world);
    if (count >= enough) break;
  }
  return count;
}

bool ObservedSpace::sees_through(const View& view, const Eigen::Vector3f& point_in_world) const {
  const Eigen::Vector3f point = view.camera_from_world * point_in_world;
  if (point.z() <= 0.f) return false;
  const Eigen::Vector2f pixel = camera_.project(point);
  const auto x = static_cast<int>(std::floor(pixel.x() + 0.5f)),
             y = static_cast<int>(std::floor(pixel.y() + 0.5f));
  if (!view.depth.contains(x, y)) return false;
  const float depth = view.depth.at(x, y);
  return depth > 0.f && point.z() < depth - std::max(config_.margin_m, config_.share * depth);
}

}  // namespace ovimap
