// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/fusion/seen_ahead.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ovimap/map/fusion/free_tiles.h"
#include "ovimap/map/rays/ray_cast.h"
#include "ovimap/map/rays/surface_lookup.h"
#include "ovimap/map/voxels/regions_in_view.h"

namespace ovimap {

namespace {

constexpr int kTile_px = 8;            // blocks are held against these
constexpr int kTilesOfRegionTile = 4;  // and regions against so many at once, each way
constexpr int kSampleStep_px = 8;
constexpr int kRaysAcross = 12;  // some hundred rays tell three quarters from a half
constexpr double kRounding_m = 1e-4;
// Of frames that see through the map, as seen_ahead.h says.
constexpr float kByFar = 0.8f;
constexpr double kNearlyAll = 0.75, kLeastKnown = 0.5;
constexpr float kLongestRay = 2.f;  // of the furthest depth: rays at the corners are longer

/// Of every so many pixels each way, those that show surface where the map has surface, whichever
/// block that is in.
int count_confirmed(const VoxelMap& map, const Observation& seen, int step_px) {
  const Eigen::Isometry3f world_from_camera = seen.world_from_camera.cast<float>();
  const float near_m = 2 * map.config().voxel_size_m;
  VoxelFinder finder(map);
  int confirmed = 0;
  for (int y = step_px / 2; y < seen.depth.height(); y += step_px)
    for (int x = step_px / 2; x < seen.depth.width(); x += step_px) {
      const float depth_m = seen.depth.at(x, y);
      if (depth_m <= 0.f) continue;
      const Eigen::Vector3f point =
          world_from_camera *
          seen.camera.unproject(static_cast<float>(x), static_cast<float>(y), depth_m);
      confirmed +=
          finder.seek(point) && finder.observed() && std::fabs(finder.distance_m()) < near_m;
    }
  return confirmed;
}

/// Squares of that side along an edge whose middle pixel is in the image.
int squares_along(int edge_px, int side_px) {
  return (edge_px + side_px / 2 - 1) / side_px;
}
/// The middle pixel of each square, of an image and of its camera.
DepthImage every(int step_px, const DepthImage& depth) {
  DepthImage sampled(squares_along(depth.width(), step_px), squares_along(depth.height(), step_px));
  for (int y = 0; y < sampled.height(); ++y)
    for (int x = 0; x < sampled.width(); ++x)
      sampled.at(x, y) = depth.at(step_px / 2 + x * step_px, step_px / 2 + y * step_px);
  return sampled;
}
PinholeCamera every(int step_px, const PinholeCamera& camera) {
  const auto step = static_cast<float>(step_px), first = static_cast<float>(step_px / 2);
  return {squares_along(camera.width, step_px),
          squares_along(camera.height, step_px),
          camera.fx / step,
          camera.fy / step,
          (camera.cx - first) / step,
          (camera.cy - first) / step};
}

}  // namespace

std::vector<BlockAhead> blocks_ahead(const VoxelMap& map, const Observation& observation,
                                     const Image<float>& free_m) {
  const FreeTiles tiles(observation.camera, kTile_px, most_of_squares(free_m, kTile_px)),
      region_tiles = tiles.coarser(kTilesOfRegionTile);
  const Pose camera_from_world = observation.world_from_camera.inverse();
  const double block_m = map.config().block_size_m(), region_m = block_m * kRegionBlocks;
  const auto middle = [&](const BlockIndex& index, double size_m) -> Eigen::Vector3f {
    const Eigen::Vector3d center = (index.cast<double>() + Eigen::Vector3d::Constant(0.5)) * size_m;
    return (camera_from_world * center).cast<float>();
  };
  const float radius = static_cast<float>(block_m) * kCubeHalfDiagonal;
  // Of a block along the optical axis, which is less than the radius; and what rounding may add.
  const auto half_depth_m = static_cast<float>(
      camera_from_world.linear().row(2).cwiseAbs().sum() * block_m / 2 + kRounding_m);
  std::vector<BlockAhead> ahead;
  const auto add_region = [&](const BlockRegion& region) {
    const Eigen::Vector3f center = middle(region.index, region_m);
    if (region_tiles.furthest(center, radius * kRegionBlocks) <= 0.f) return;
    for (const std::uint32_t slot : region.slots) {
      if (slot == kNoBlock || (observation.blocks && !observation.blocks->contains(slot))) continue;
      const Eigen::Vector3f block = middle(map.block_index(slot), block_m);
      const float free = tiles.furthest(block, radius);
      if (free > 0.f && block.z() - half_depth_m < free) ahead.push_back({slot, free});
    }
  };
  for_each_region_in_view(map, observation.camera, observation.world_from_camera, tiles.most_m(),
                          add_region);
  std::sort(ahead.begin(), ahead.end(), [&map](const BlockAhead& a, const BlockAhead& b) {
    return pack_index(map.block_index(a.slot)) < pack_index(map.block_index(b.slot));
  });
  return ahead;
}

double confirmed_px(const VoxelMap& map, const Observation& observation) {
  return static_cast<double>(count_confirmed(map, observation, kSampleStep_px)) * kSampleStep_px *
         kSampleStep_px;
}

bool sees_through_map(const VoxelMap& map, const Observation& observation) {
  const int step_px = std::max(2, observation.depth.width() / kRaysAcross);
  const DepthImage seen = every(step_px, observation.depth);
  if (seen.size() == 0 || map.block_count() == 0) return false;
  const float furthest_m = *std::max_element(seen.begin(), seen.end());
  if (furthest_m <= 0.f) return false;
  const auto samples =
      std::count_if(seen.begin(), seen.end(), [](float depth_m) { return depth_m > 0.f; });
  if (count_confirmed(map, observation, step_px) > (1 - kNearlyAll) * static_cast<double>(samples))
    return false;
  const DepthImage known = cast_rays(map, every(step_px, observation.camera),
                                     observation.world_from_camera, kLongestRay * furthest_m)
                               .depth;
  int both = 0, through = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] <= 0.f || known[i] <= 0.f) continue;
    ++both;
    through += known[i] < kByFar * seen[i];
  }
  return both >= kLeastKnown * static_cast<double>(samples) && through >= kNearlyAll * both;
}

}  // namespace ovimap
