// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/fusion/seen_ahead.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ovimap/map/fusion/free_tiles.h"
#include "ovimap/map/rays/ray_cast.h"
#include "ovimap/map/rays/surface_lookup.h"

namespace ovimap {

namespace {

constexpr int kTile_px = 8;            // blocks are held against these
constexpr int kTilesOfRegionTile = 4;  // and regions against so many at once, each way
constexpr int kSampleStep_px = 8;
constexpr int kRaysAcross = 12;  // some hundred rays tell three quarters from a half
constexpr float kBeside_m = 0.05f;
constexpr double kRounding_m = 1e-4;
// Of frames that see through the map, as seen_ahead.h says.
constexpr float kByFar = 0.8f;
constexpr double kNearlyAll = 0.75, kLeastKnown = 0.5;
constexpr float kLongestRay = 2.f;  // of the furthest depth: rays at the corners are longer

Image<float> most_of_squares(const Image<float>& values, int side) {
  return joined_squares(values, side, 0.f, [](float a, float b) { return a < b ? b : a; });
}

/// Furthest free depth by tile of the image.
class FreeTiles {
 public:
  FreeTiles(const PinholeCamera& camera, int tile_px, Image<float> furthest_m)
      : camera_(camera), tile_px_(tile_px), furthest_m_(std::move(furthest_m)) {
    for (const float furthest : furthest_m_) most_m_ = std::max(most_m_, furthest);
  }
  FreeTiles coarser(int side) const {
    return {camera_, tile_px_ * side, most_of_squares(furthest_m_, side)};
  }

  /// Of the tiles that a sphere may show in; 0 where all of it lies behind that.
  float furthest(const Eigen::Vector3f& center, float radius) const {
    const float near_m = center.z() - radius, far_m = center.z() + radius;
    if (far_m <= 0.f || near_m >= most_m_) return 0.f;
    if (near_m < kBeside_m)  // around the camera, or beside it
      return beyond_view(camera_, center, radius) ? 0.f : most_m_;
    const auto [left, right] = span(center.x(), radius, near_m, far_m, camera_.fx, camera_.cx);
    const auto [top, bottom] = span(center.y(), radius, near_m, far_m, camera_.fy, camera_.cy);
    float furthest = 0.f;
    for (int y = std::max(top, 0); y <= std::min(bottom, furthest_m_.height() - 1); ++y)
      for (int x = std::max(left, 0); x <= std::min(right, furthest_m_.width() - 1); ++x)
        furthest = std::max(furthest, furthest_m_.at(x, y));
    return near_m < furthest ? furthest : 0.f;
  }

 private:
  /// First and last tile along one axis: an edge shows furthest out at its nearest depth where it
  /// lies off the axis to that side, else at its furthest.
  std::pair<int, int> span(float center, float radius, float near_m, float far_m, float focal,
                           float principal) const {
    const float low = center - radius, high = center + radius;
    return {tile(principal + focal * low / (low < 0 ? near_m : far_m)),
            tile(principal + focal * high / (high > 0 ? near_m : far_m))};
  }
  int tile(float pixel) const {
    constexpr float kFar_px = 1e6f;
    return static_cast<int>(
        std::floor((std::clamp(pixel, -kFar_px, kFar_px) + 0.5f) / static_cast<float>(tile_px_)));
  }

  const PinholeCamera& camera_;
  int tile_px_;
  Image<float> furthest_m_;
  float most_m_ = 0;
};

/// Whether the map has surface where a pixel shows it, whichever block that is in.
class SurfaceProbe {
 public:
  SurfaceProbe(const VoxelMap& map, const Observation& seen)
      : seen_(seen),
        world_from_camera_(seen.world_from_camera.cast<float>()),
        near_m_(2 * map.config().voxel_size_m),
        finder_(map) {}

  bool confirms(int x, int y) {
    const float depth_m = seen_.depth.at(x, y);
    return depth_m > 0.f &&
           finder_.seek(world_from_camera_ * seen_.camera.unproject(static_cast<float>(x),
                                                                    static_cast<float>(y),
                                                                    depth_m)) &&
           finder_.observed() && std::fabs(finder_.distance_m()) < near_m_;
  }

 private:
  const Observation& seen_;
  Eigen::Isometry3f world_from_camera_;
  float near_m_;
  VoxelFinder finder_;
};

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

/// Of the pixels that `every` takes, those that have depth.
bool confirms_more_than(double share, const VoxelMap& map, const Observation& observation,
                        int step_px) {
  SurfaceProbe probe(map, observation);
  int samples = 0, confirmed = 0;
  for (int y = step_px / 2; y < observation.depth.height(); y += step_px)
    for (int x = step_px / 2; x < observation.depth.width(); x += step_px) {
      samples += observation.depth.at(x, y) > 0.f;
      confirmed += probe.confirms(x, y);
    }
  return confirmed > share * samples;
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
  map.for_each_region([&](const BlockRegion& region) {
    const Eigen::Vector3f center = middle(region.index, region_m);
    if (region_tiles.furthest(center, radius * kRegionBlocks) <= 0.f) return;
    for (const std::uint32_t slot : region.slots) {
      if (slot == kNoBlock || (observation.blocks && !observation.blocks->contains(slot))) continue;
      const Eigen::Vector3f block = middle(map.block_index(slot), block_m);
      const float free = tiles.furthest(block, radius);
      if (block.z() - half_depth_m < free) ahead.push_back({slot, free});
    }
  });
  std::sort(ahead.begin(), ahead.end(), [&map](const BlockAhead& a, const BlockAhead& b) {
    return pack_index(map.block_index(a.slot)) < pack_index(map.block_index(b.slot));
  });
  return ahead;
}

double confirmed_px(const VoxelMap& map, const Observation& observation) {
  SurfaceProbe probe(map, observation);
  int confirmed = 0;
  for (int y = kSampleStep_px / 2; y < observation.depth.height(); y += kSampleStep_px)
    for (int x = kSampleStep_px / 2; x < observation.depth.width(); x += kSampleStep_px)
      confirmed += probe.confirms(x, y);
  return static_cast<double>(confirmed) * kSampleStep_px * kSampleStep_px;
}

bool sees_through_map(const VoxelMap& map, const Observation& observation) {
  const int step_px = std::max(2, observation.depth.width() / kRaysAcross);
  const DepthImage seen = every(step_px, observation.depth);
  if (seen.size() == 0 || map.block_count() == 0) return false;
  const float furthest_m = *std::max_element(seen.begin(), seen.end());
  if (furthest_m <= 0.f) return false;
  if (confirms_more_than(1 - kNearlyAll, map, observation, step_px)) return false;
  const DepthImage known = cast_rays(map, every(step_px, observation.camera),
                                     observation.world_from_camera, kLongestRay * furthest_m)
                               .depth;
  int samples = 0, both = 0, through = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] <= 0.f) continue;
    ++samples;
    if (known[i] <= 0.f) continue;
    ++both;
    through += known[i] < kByFar * seen[i];
  }
  return both >= kLeastKnown * samples && through >= kNearlyAll * both;
}

}  // namespace ovimap
