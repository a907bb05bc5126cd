// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/ray_cast.h"

#include <gtest/gtest.h>

#include "ovimap/map/sphere_fixture.h"
#include "ovimap/map/surface_lookup.h"

namespace ovimap {
namespace {

class RayCastTest : public ::testing::Test {
 protected:
  RayCastTest() { scene_.integrate_views(map_, 12, label_); }
  SphereScene scene_;
  VoxelMap map_;
  Label label_ = map_.labels().create();
};

TEST_F(RayCastTest, SeesTheSphereFromANewView) {
  const DepthImage expected = scene_.depth();
  const Projection seen = cast_rays(map_, scene_.camera, scene_.pose(0.2), 5.f);
  int hits = 0, inner = 0, labelled = 0;
  for (int y = 30; y < 90; ++y)
    for (int x = 50; x < 110; ++x) {
      if (expected.at(x, y) <= 0.f || Eigen::Vector2f(x - 79.5f, y - 59.5f).norm() > 22.f) continue;
      ++inner;
      if (seen.depth.at(x, y) <= 0.f) continue;
      ++hits;
      EXPECT_NEAR(seen.depth.at(x, y), expected.at(x, y), 0.008f);
      labelled += seen.labels.at(x, y) == label_;
    }
  EXPECT_EQ(hits, inner);
  EXPECT_GT(labelled, inner * 9 / 10);
  EXPECT_EQ(seen.depth.at(2, 2), 0.f) << "nothing there";
  EXPECT_EQ(seen.labels.at(2, 2), kNoLabel);
}

TEST_F(RayCastTest, LeapsFromFarAway) {
  Pose pose = scene_.pose(0);
  pose.translation() *= 7.0;  // 8.4 m away, across many empty regions
  const Projection seen = cast_rays(map_, scene_.camera, pose, 20.f);
  EXPECT_NEAR(seen.depth.at(79, 59), 8.4f - SphereScene::kRadius, 0.01f);
}

TEST_F(RayCastTest, SensorDepthGuidesWithoutChangingTheAnswer) {
  const DepthImage depth = scene_.depth();
  const Pose pose = scene_.pose(0);
  const auto surface = surface_voxels(map_, depth, scene_.camera, pose);
  const Projection guided = cast_rays_with_depth(map_, depth, surface, scene_.camera, pose, 5.f);
  const Projection marched = cast_rays(map_, scene_.camera, pose, 5.f);
  for (int y = 45; y < 75; ++y)
    for (int x = 65; x < 95; ++x) {
      EXPECT_NEAR(guided.depth.at(x, y), marched.depth.at(x, y), 0.008f);
      EXPECT_EQ(guided.labels.at(x, y), marched.labels.at(x, y));
    }
}

TEST(RayCast, EmptyMapIsNothingAndEnds) {
  const SphereScene scene;
  const Projection seen = cast_rays(VoxelMap(), scene.camera, scene.pose(0), 10.f);
  for (float depth : seen.depth) EXPECT_EQ(depth, 0.f);
}

}  // namespace
}  // namespace ovimap
