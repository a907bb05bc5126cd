// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/voxels/tile_ranges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ovimap/map/voxels/regions_in_view.h"

namespace ovimap {

namespace {
constexpr float kNearPlane_m = 0.05f;
}  // namespace

TileRanges::TileRanges(const VoxelMap& map, const PinholeCamera& camera,
                       const Pose& world_from_camera, float max_depth_m)
    : camera_(camera),
      camera_from_world_(world_from_camera.linear().transpose().cast<float>()),
      ranges_((camera.width + kTile_px - 1) / kTile_px, (camera.height + kTile_px - 1) / kTile_px,
              {std::numeric_limits<float>::max(), 0.f}) {
  const Pose camera_from_world = world_from_camera.inverse();
  const double block = map.config().block_size_m();
  const double region = block * kRegionBlocks;
  const auto region_radius = static_cast<float>(region * kCubeHalfDiagonal);
  // A sphere is out of view when it lies behind one of the image's side planes.
  const float corner =
      std::max({camera.cx + 0.5f, static_cast<float>(camera.width) - camera.cx}) / camera.fx;
  const float side =
      std::max({camera.cy + 0.5f, static_cast<float>(camera.height) - camera.cy}) / camera.fy;
  const auto in_view = [&](const Eigen::Vector3f& c, float radius) {
    if (c.z() < -radius || c.z() - radius > max_depth_m) return false;
    return std::fabs(c.x()) <= corner * c.z() + radius * std::sqrt(1.f + corner * corner) &&
           std::fabs(c.y()) <= side * c.z() + radius * std::sqrt(1.f + side * side);
  };
  const auto add_region = [&](const BlockRegion& blocks) {
    const Eigen::Vector3d center =
        (blocks.index.cast<double>() + Eigen::Vector3d::Constant(0.5)) * region;
    if (!in_view((camera_from_world * center).cast<float>(), region_radius)) return;
    for (std::uint32_t slot : blocks.slots) {
      if (slot == kNoBlock) continue;
      const Eigen::Vector3d middle =
          (map.block_index(slot).cast<double>() + Eigen::Vector3d::Constant(0.5)) * block;
      const Eigen::Vector3f c = (camera_from_world * middle).cast<float>();
      if (in_view(c, static_cast<float>(block) * kCubeHalfDiagonal))
        add_block(c, static_cast<float>(block) / 2);
    }
  };
  for_each_region_in_view(map, camera, world_from_camera, max_depth_m, add_region);
}

void TileRanges::add_block(const Eigen::Vector3f& center, float half_side) {
  const float radius = half_side * 2.f * kCubeHalfDiagonal;
  const float near_m = std::max(center.z() - radius, 0.f), far_m = center.z() + radius;
  if (near_m < kNearPlane_m)  // around the camera: it may cover any pixel
    return widen(0, 0, static_cast<float>(camera_.width), static_cast<float>(camera_.height),
                 near_m, far_m);
  Eigen::Vector2f low = Eigen::Vector2f::Constant(std::numeric_limits<float>::max()), high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f sign(corner & 1 ? half_side : -half_side,
                               corner & 2 ? half_side : -half_side,
                               corner & 4 ? half_side : -half_side);
    Eigen::Vector3f point = center + camera_from_world_ * sign;
    point.z() = std::max(point.z(), kNearPlane_m);
    const Eigen::Vector2f pixel = camera_.project(point);
    low = low.cwiseMin(pixel), high = high.cwiseMax(pixel);
  }
  widen(low.x(), low.y(), high.x(), high.y(), near_m, far_m);
}

void TileRanges::widen(float u_min, float v_min, float u_max, float v_max, float near_m,
                       float far_m) {
  const auto tile = [](float pixel, int count) {
    return std::clamp(static_cast<int>(std::floor(pixel / kTile_px)), 0, count - 1);
  };
  if (u_max < 0 || v_max < 0 || u_min >= static_cast<float>(camera_.width) ||
      v_min >= static_cast<float>(camera_.height))
    return;
  for (int y = tile(v_min, ranges_.height()); y <= tile(v_max, ranges_.height()); ++y) {
    for (int x = tile(u_min, ranges_.width()); x <= tile(u_max, ranges_.width()); ++x) {
      Range& range = ranges_.at(x, y);
      range.near_m = std::min(range.near_m, near_m);
      range.far_m = std::max(range.far_m, far_m);
    }
  }
}

}  // namespace ovimap
