// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/voxels/regions_in_view.h"

#include <set>

#include <gtest/gtest.h>

#include "ovimap/geometry/view_bounds.h"

namespace ovimap {
namespace {

/// A floor of blocks, 3 m wide, along x.
VoxelMap floor_of(int length_blocks) {
  VoxelMapConfig config;
  config.voxel_size_m = 0.01f;
  VoxelMap map(config);
  for (int x = -length_blocks / 2; x < length_blocks / 2; ++x)
    for (int y = -19; y < 19; ++y) map.find_or_create({x, y, 0});
  return map;
}

std::set<std::uint64_t> visited(const VoxelMap& map, const PinholeCamera& camera, const Pose& pose,
                                float far_m) {
  std::set<std::uint64_t> keys;
  for_each_region_in_view(map, camera, pose, far_m, [&](const BlockRegion& region) {
    EXPECT_TRUE(keys.insert(pack_index(region.index)).second);
  });
  return keys;
}

TEST(RegionsInView, AreAllWhoseBlocksTheViewTouchesAndFewOthersOfALargeMap) {
  const PinholeCamera camera{320, 240, 290.f, 290.f, 159.5f, 119.5f};
  const VoxelMap map = floor_of(5000);  // 400 m
  std::size_t all = 0;
  map.for_each_region([&](const BlockRegion&) { ++all; });
  const double block_m = map.config().block_size_m();
  const auto radius = static_cast<float>(block_m) * kCubeHalfDiagonal;
  constexpr float kFar_m = 4.f;
  for (const double turn : {0., 0.7, 2.1, 3.1}) {
    Pose pose = Pose::Identity();
    pose.linear() = (Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(2.2, Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
    pose.translation() = Eigen::Vector3d(37, 0.4, 1.5);
    const std::set<std::uint64_t> found = visited(map, camera, pose, kFar_m);
    EXPECT_LT(found.size(), all / 10);
    std::size_t touched = 0;
    map.for_each_region([&](const BlockRegion& region) {
      for (const std::uint32_t slot : region.slots) {
        if (slot == kNoBlock) continue;
        const Eigen::Vector3d middle =
            (map.block_index(slot).cast<double>() + Eigen::Vector3d::Constant(0.5)) * block_m;
        const Eigen::Vector3f center = (pose.inverse() * middle).cast<float>();
        if (center.z() < -radius || center.z() - radius > kFar_m ||
            beyond_view(camera, center, radius))
          continue;
        ++touched;
        EXPECT_TRUE(found.contains(pack_index(region.index))) << region.index.transpose();
      }
    });
    EXPECT_GT(touched, 50u);
  }
}

TEST(RegionsInView, AreAllOfASmallMapOrAnEndlessView) {
  const PinholeCamera camera{320, 240, 290.f, 290.f, 159.5f, 119.5f};
  for (const int length : {10, 3000}) {
    const VoxelMap map = floor_of(length);
    std::size_t all = 0;
    map.for_each_region([&](const BlockRegion&) { ++all; });
    EXPECT_EQ(visited(map, camera, Pose::Identity(), 1e6f).size(), all);
  }
  EXPECT_EQ(visited(floor_of(10), camera, Pose::Identity(), 4.f).size(), 12u);
}

}  // namespace
}  // namespace ovimap
