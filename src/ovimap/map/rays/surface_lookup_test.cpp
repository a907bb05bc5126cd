// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/rays/surface_lookup.h"

#include <gtest/gtest.h>

#include "ovimap/map/rays/sphere_fixture.h"

namespace ovimap {
namespace {

TEST(SurfaceVoxels, FindsTheVoxelThatHoldsThePoint) {
  const SphereScene scene;
  VoxelMap map;
  scene.integrate_views(map, 8, map.labels().create());
  const Pose pose = scene.pose(0);
  const DepthImage depth = scene.depth();
  const auto surface = surface_voxels(map, depth, scene.camera, pose);
  for (int y = 50; y < 70; ++y)
    for (int x = 70; x < 90; ++x) {
      ASSERT_TRUE(surface.at(x, y));
      const Eigen::Vector3f point =
          pose.cast<float>() *
          scene.camera.unproject(static_cast<float>(x), static_cast<float>(y), depth.at(x, y));
      const VoxelBlock& block = map.block(surface.at(x, y).block());
      const int v = surface.at(x, y).voxel();
      const Eigen::Vector3f low =
          (block.index * 8 + Eigen::Vector3i(v & 7, v >> 3 & 7, v >> 6)).cast<float>() * 0.01f;
      EXPECT_TRUE(((point - low).array() > -1e-4f).all() &&
                  ((point - low).array() < 0.0101f).all());
    }
  EXPECT_FALSE(surface.at(0, 0)) << "no depth there";
}

TEST(SurfaceVoxels, FollowsANoisyPointBackToTheSurface) {
  const SphereScene scene;
  VoxelMap map;
  scene.integrate_views(map, 8, map.labels().create());
  DepthImage depth = scene.depth();
  for (float& z : depth) z += z > 0.f ? 0.03f : 0.f;
  EXPECT_TRUE(surface_voxels(map, depth, scene.camera, scene.pose(0)).at(80, 60));
  for (float& z : depth) z += z > 0.f ? 0.2f : 0.f;
  EXPECT_FALSE(surface_voxels(map, depth, scene.camera, scene.pose(0)).at(80, 60))
      << "beyond the band";
}

/// Eight pixels are looked up at once; what a row has beyond, and narrow images, alike.
TEST(SurfaceVoxels, AnyWidthGivesTheSameVoxels) {
  const SphereScene scene;
  VoxelMap map;
  scene.integrate_views(map, 8, map.labels().create());
  const DepthImage depth = scene.depth();
  const auto whole = surface_voxels(map, depth, scene.camera, scene.pose(0));
  for (const int width : {1, 7, 8, 13, 40}) {
    constexpr int kLeft = 70;
    PinholeCamera camera = scene.camera;
    camera.width = width, camera.cx -= kLeft;
    DepthImage part(width, depth.height());
    for (int y = 0; y < depth.height(); ++y)
      for (int x = 0; x < width; ++x) part.at(x, y) = depth.at(kLeft + x, y);
    const auto surface = surface_voxels(map, part, camera, scene.pose(0));
    for (int y = 0; y < depth.height(); ++y)
      for (int x = 0; x < width; ++x)
        ASSERT_EQ(surface.at(x, y).value, whole.at(kLeft + x, y).value)
            << width << " pixels wide, at " << x << ", " << y;
  }
}

}  // namespace
}  // namespace ovimap
