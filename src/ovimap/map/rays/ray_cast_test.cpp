// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/rays/ray_cast.h"

#include <gtest/gtest.h>

#include <random>

#include "ovimap/map/rays/plain_ray_cast.h"
#include "ovimap/map/rays/sphere_fixture.h"
#include "ovimap/map/rays/surface_lookup.h"

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

/// How often two projections disagree, among the pixels where either has a surface.
struct Disagreement {
  int surface = 0, one_sided = 0, depth = 0, label = 0;

  Disagreement(const Projection& a, const Projection& b, float tolerance_m) {
    for (std::size_t i = 0; i < a.depth.size(); ++i) {
      if (a.depth[i] <= 0.f && b.depth[i] <= 0.f) continue;
      ++surface;
      if (a.depth[i] <= 0.f || b.depth[i] <= 0.f)
        ++one_sided;
      else if (std::fabs(a.depth[i] - b.depth[i]) > tolerance_m)
        ++depth;
      else
        label += a.labels[i] != b.labels[i];
    }
  }
};

TEST_F(RayCastTest, AgreesWithThePlainMarch) {
  for (const double azimuth : {0.1, 1.3, 2.9}) {
    const Pose pose = scene_.pose(azimuth);
    const Disagreement found(cast_rays(map_, scene_.camera, pose, 5.f),
                             plain::cast_rays(map_, scene_.camera, pose, 5.f), 0.001f);
    EXPECT_GT(found.surface, 3000);
    // Rays that graze the rim may miss what the other march just meets.
    EXPECT_LE(found.one_sided, found.surface / 30);
    EXPECT_LE(found.depth, found.surface / 30);
    EXPECT_LE(found.label, found.surface / 200);
  }
}

TEST(RayCast, AgreesWithThePlainMarchOnNoisyDepth) {
  const SphereScene scene;
  VoxelMap map;
  const Label label = map.labels().create();
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0.f, 0.01f);
  for (int view = 0; view < 6; ++view) {
    DepthImage depth = scene.depth();
    for (float& d : depth) d = d > 0.f && random() % 10 != 0 ? d + noise(random) : 0.f;
    const IdImage segments(depth.width(), depth.height(), 1);
    const std::array<Label, 1> labels{label};
    integrate(map, {.depth = depth,
                    .camera = scene.camera,
                    .world_from_camera = scene.pose(0.2 * view),
                    .segment_ids = &segments,
                    .segment_labels = labels});
  }
  const Pose pose = scene.pose(0.5);
  const Disagreement found(cast_rays(map, scene.camera, pose, 5.f),
                           plain::cast_rays(map, scene.camera, pose, 5.f), 0.005f);
  EXPECT_GT(found.surface, 3000);
  EXPECT_LE(found.one_sided, found.surface / 20);
  EXPECT_LE(found.depth, found.surface / 20);
}

TEST(RayCast, EmptyMapIsNothingAndEnds) {
  const SphereScene scene;
  const Projection seen = cast_rays(VoxelMap(), scene.camera, scene.pose(0), 10.f);
  for (float depth : seen.depth) EXPECT_EQ(depth, 0.f);
}

}  // namespace
}  // namespace ovimap
