// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/rays/observed_space.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "ovimap/base/config.h"
#include "ovimap/geometry/view_bounds.h"
#include "ovimap/map/rays/ray_cast.h"

namespace ovimap {

namespace {

/// As many as a room gets, for each part of a building that is as large as a flat.
std::size_t views_for(std::span<const Pose> world_from_camera, const ObservedSpaceConfig& config) {
  Eigen::AlignedBox3d box;
  for (const Pose& pose : world_from_camera) box.extend(pose.translation());
  Eigen::Vector3d sides = box.sizes();
  std::sort(sides.begin(), sides.end());  // whatever is up, cameras span least that way
  const double parts = std::max(1.0, sides[1] * sides[2] / double{config.area_m2});
  return static_cast<std::size_t>(config.max_views * parts);
}

}  // namespace

void list_fields(ObservedSpaceConfig& config, ConfigFields& fields) {
  fields.add("width_px", config.width_px, 8, 4096, "width of the images that stand for frames");
  fields.add("max_views", config.max_views, 1, 1000000, "frames looked at, evenly spread, ...");
  fields.add("area_m2", config.area_m2, 1.f, 1e9f,
             "... for every such area that the cameras span, square metres");
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
                    count = std::min(frames, views_for(world_from_camera, config));
  views_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    cast(map, world_from_camera[(2 * i + 1) * frames / (2 * count)], views_[i]);
    map.trim();
  }
}

void ObservedSpace::cast(const VoxelMap& map, const Pose& world_from_camera, View& view) const {
  view.camera_from_world = world_from_camera.inverse().cast<float>();
  view.depth = cast_rays(map, camera_, world_from_camera, config_.max_range_m).depth;
  view.farthest =
      Image<float>((camera_.width + kTile - 1) / kTile, (camera_.height + kTile - 1) / kTile, 0.f);
  for (int y = 0; y < camera_.height; ++y)
    for (int x = 0; x < camera_.width; ++x) {
      float& farthest = view.farthest.at(x / kTile, y / kTile);
      farthest = std::max(farthest, view.depth.at(x, y));
    }
}

std::vector<std::uint32_t> ObservedSpace::views_into(const Eigen::Vector3f& center_in_world,
                                                     float radius_m) const {
  std::vector<std::uint32_t> into;
  for (std::uint32_t i = 0; i < views_.size(); ++i)
    if (may_see_through(views_[i], center_in_world, radius_m)) into.push_back(i);
  return into;
}

int ObservedSpace::seen_through(const Eigen::Vector3f& point_in_world,
                                std::span<const std::uint32_t> views, int enough) const {
  int count = 0;
  for (const std::uint32_t view : views) {
    count += sees_through(views_[view], point_in_world);
    if (count >= enough) break;
  }
  return count;
}

bool ObservedSpace::may_see_through(const View& view, const Eigen::Vector3f& center_in_world,
                                    float radius_m) const {
  constexpr float kRounding_m = 1e-4f;
  radius_m += kRounding_m;
  const Eigen::Vector3f center = view.camera_from_world * center_in_world;
  if (center.z() + radius_m <= 0.f || center.z() - radius_m >= config_.max_range_m) return false;
  if (beyond_view(camera_, center, radius_m)) return false;
  return center.z() - radius_m < farthest_in(view, center, radius_m);
}

/// The largest depth of what a ball covers in the picture.
float ObservedSpace::farthest_in(const View& view, const Eigen::Vector3f& center,
                                 float radius_m) const {
  if (center.z() - radius_m <= 0.f) return config_.max_range_m;  // it may cover everything
  const Eigen::AlignedBox2f covered = pixels_around(camera_, center, radius_m);
  const auto tile = [](float pixel, int tiles) {
    return std::clamp(static_cast<int>(std::floor((pixel + 0.5f) / kTile)), 0, tiles - 1);
  };
  const int left = tile(covered.min().x(), view.farthest.width()),
            right = tile(covered.max().x(), view.farthest.width()),
            top = tile(covered.min().y(), view.farthest.height()),
            bottom = tile(covered.max().y(), view.farthest.height());
  float farthest = 0.f;
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x) farthest = std::max(farthest, view.farthest.at(x, y));
  return farthest;
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
