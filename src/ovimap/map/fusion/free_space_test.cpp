// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/fusion/free_space.h"

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"
#include "ovimap/map/fusion/plain_free_space.h"
#include "ovimap/map/fusion/seen_ahead.h"

namespace ovimap {
namespace {

constexpr float kWall_m = 3.f, kBox_m = 1.5f;

/// A wall across the view at 3 m, and a box before it that may be gone.
struct Stage {
  PinholeCamera camera{160, 120, 150.f, 150.f, 79.5f, 59.5f};
  DepthImage depth{160, 120, kWall_m};
  Image<float> slope{160, 120, 1.f}, sigma{160, 120, 0.002f};
  Pose pose = Pose::Identity();

  Observation observation() const {
    return {.depth = depth,
            .camera = camera,
            .world_from_camera = pose,
            .plane_slope = &slope,
            .sigma_m = &sigma};
  }
  /// Half as many pixels to every side of the image's centre.
  void put_box(int half_px) {
    for (int y = 60 - half_px; y < 60 + half_px; ++y)
      for (int x = 80 - half_px; x < 80 + half_px; ++x) depth.at(x, y) = kBox_m;
  }
};

/// Voxels with weight whose centre lies nearer than the wall's band.
std::size_t voxels_of_box(const VoxelMap& map) {
  std::size_t count = 0;
  for (std::uint32_t slot = 0; slot < map.block_count(); ++slot)
    for (int v = 0; v < kBlockVoxels; ++v) {
      const float z =
          (static_cast<float>(map.block_index(slot).z() * kBlockSide + (v >> 6)) + 0.5f) *
          map.config().voxel_size_m;
      count += z < 2.f && map.distance_m(map.block(slot), v) < 0.005f &&
               map.block(slot).weight[static_cast<std::size_t>(v)] > 0.f;
    }
  return count;
}

VoxelMap map_with_box(int half_px) {
  Stage before;
  before.put_box(half_px);
  VoxelMap map;
  for (int i = 0; i < 10; ++i) integrate(map, before.observation());
  return map;
}

TEST(FreeSpace, TakesBackWhatThreeFramesSeeThrough) {
  VoxelMap map = map_with_box(20);
  const std::size_t before = voxels_of_box(map);
  ASSERT_GT(before, 1000u);
  const Stage after;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(voxels_of_box(map), before) << i << " frames are too few";
    EXPECT_FALSE(clear_free_space(map, after.observation(), {}).refused);
    integrate(map, after.observation());
  }
  EXPECT_EQ(voxels_of_box(map), 0u);
}

TEST(FreeSpace, KeepsAWallThatIsSeen) {
  const Stage wall;
  VoxelMap map;
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(clear_free_space(map, wall.observation(), {}).doubted, 0u);
    integrate(map, wall.observation());
  }
}

TEST(FreeSpace, KeepsAWallThatIsSeenWithinTheMarginOrTheNoiseBehindItsPlace) {
  Stage wall;
  VoxelMap map;
  for (int i = 0; i < 10; ++i) integrate(map, wall.observation());
  wall.depth.fill(kWall_m + 0.015f);
  EXPECT_EQ(clear_free_space(map, wall.observation(), {}).doubted, 0u);
  wall.depth.fill(kWall_m + 0.3f);
  wall.sigma.fill(0.08f);
  EXPECT_EQ(clear_free_space(map, wall.observation(), {}).doubted, 0u);
}

TEST(FreeSpace, SurfaceThatIsSeenAgainIsDoubtedNoMore) {
  VoxelMap map = map_with_box(20);
  Stage present;
  present.put_box(20);
  const std::size_t before = voxels_of_box(map);
  const Stage absent;
  for (int i = 0; i < 12; ++i) {
    const Stage& stage = i % 3 == 2 ? present : absent;
    clear_free_space(map, stage.observation(), {});
    if (i % 3 == 2) integrate(map, stage.observation());
  }
  EXPECT_GT(voxels_of_box(map), before * 8 / 10) << "surface that one frame in three shows stays";
}

TEST(FreeSpace, HolesGrazingRaysAndUnknownDeviationsTakeNothing) {
  VoxelMap map = map_with_box(20);
  const std::size_t before = voxels_of_box(map);
  Stage holes, grazing, unknown;
  for (std::size_t i = 0; i < holes.depth.size(); i += 5) holes.depth[i] = 0.f;
  grazing.slope.fill(0.1f);
  Observation observation = unknown.observation();
  observation.sigma_m = nullptr;
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(clear_free_space(map, holes.observation(), {}).doubted, 0u);
    EXPECT_EQ(clear_free_space(map, grazing.observation(), {}).doubted, 0u);
    EXPECT_EQ(clear_free_space(map, observation, {}).doubted, 0u);
  }
  EXPECT_EQ(voxels_of_box(map), before);
}

TEST(FreeSpace, ThinThingsStayThoughNoiseMovesThemByPixels) {
  Stage thin;  // a bar of three pixels, now here and now two pixels further
  VoxelMap map;
  const auto put_bar = [&](int first) {
    thin.depth.fill(kWall_m);
    for (int y = 0; y < 120; ++y)
      for (int x = first; x < first + 3; ++x) thin.depth.at(x, y) = kBox_m;
  };
  put_bar(80);
  for (int i = 0; i < 10; ++i) integrate(map, thin.observation());
  ASSERT_GT(voxels_of_box(map), 100u);
  for (int i = 0; i < 10; ++i) {
    put_bar(i % 2 == 0 ? 78 : 82);
    EXPECT_EQ(clear_free_space(map, thin.observation(), {}).doubted, 0u);
  }
}

TEST(FreeSpace, AFrameThatContradictsMoreThanItConfirmsIsNotBelieved) {
  const Stage wall;
  VoxelMap map;
  for (int i = 0; i < 10; ++i) integrate(map, wall.observation());
  Stage far;
  far.depth.fill(6.f);
  const ClearedSpace cleared = clear_free_space(map, far.observation(), {});
  EXPECT_TRUE(cleared.refused);
  EXPECT_TRUE(cleared.slots.empty());
}

TEST(FreeSpace, AFrameThatSeesThroughNearlyAllOfTheMapIsKnown) {
  const Stage wall;
  VoxelMap map;
  EXPECT_FALSE(sees_through_map(map, wall.observation())) << "nothing is known";
  for (int i = 0; i < 10; ++i) integrate(map, wall.observation());
  EXPECT_FALSE(sees_through_map(map, wall.observation()));
  Stage other;
  other.depth.fill(6.f);
  EXPECT_TRUE(sees_through_map(map, other.observation()));
  const float wall_m = wall.depth[0];
  other.depth.fill(1.15f * wall_m);
  EXPECT_FALSE(sees_through_map(map, other.observation())) << "poses drift";
  other.depth.fill(0.5f * wall_m);
  EXPECT_FALSE(sees_through_map(map, other.observation())) << "something stands before it";
  other.depth = wall.depth;
  for (int y = 0; y < other.depth.height() / 2; ++y)
    for (int x = 0; x < other.depth.width(); ++x) other.depth.at(x, y) = 6.f;
  EXPECT_FALSE(sees_through_map(map, other.observation())) << "half of it is where it was";
  other.depth.fill(0.f);
  EXPECT_FALSE(sees_through_map(map, other.observation()));
}

/// A frame with noise, holes, slants and a box, from a pose of its own.
Stage rough_stage(std::uint32_t seed, bool box) {
  Stage stage;
  if (box) stage.put_box(25);
  for (std::size_t i = 0; i < stage.depth.size(); ++i) {
    seed = seed * 1664525u + 1013904223u;
    stage.depth[i] += 0.01f * (static_cast<float>(seed >> 8) / 16777216.f - 0.5f);
    if (seed >> 26 == 0) stage.depth[i] = 0.f;
    if (seed >> 26 == 1) stage.slope[i] = 0.f;
    if (seed >> 28 == 2) stage.slope[i] = 0.6f;
  }
  stage.pose.translation() = Eigen::Vector3d(0.02 * (seed >> 30), 0.01 * (seed >> 29), 0);
  return stage;
}

TEST(FreeSpace, EqualsThePlainClearingToTheBit) {
  VoxelMap fast, plain;
  for (std::uint32_t i = 0; i < 16; ++i) {
    const Stage stage = rough_stage(7 + i, i < 6);
    EXPECT_FALSE(clear_free_space(fast, stage.observation(), {}).refused);
    integrate(fast, stage.observation());
    plain::clear_free_space(plain, stage.observation(), {});
    integrate(plain, stage.observation());
    ASSERT_EQ(fast.content_hash(), plain.content_hash()) << "frame " << i;
  }
  EXPECT_LT(voxels_of_box(fast), 500u);
}

TEST(FreeSpace, GivesTheSameBitsForEveryThreadCount) {
  const auto hash = [](int threads) {
    ThreadLimit limit(threads);
    VoxelMap map;
    for (std::uint32_t i = 0; i < 9; ++i) {
      const Stage stage = rough_stage(7 + i, i < 4);
      clear_free_space(map, stage.observation(), {});
      integrate(map, stage.observation());
    }
    return map.content_hash();
  };
  EXPECT_EQ(hash(1), hash(2));
}

TEST(SeparateLooks, CountFramesFromWhichTheCameraHasMovedOn) {
  SeparateLooks looks;
  const FreeSpaceConfig config;
  Pose pose = Pose::Identity();
  EXPECT_TRUE(looks.next(pose, config));
  EXPECT_FALSE(looks.next(pose, config));
  pose.translation().x() = 0.006;
  EXPECT_FALSE(looks.next(pose, config));
  pose.translation().x() = 0.012;
  EXPECT_TRUE(looks.next(pose, config)) << "small steps add up";
  pose.linear() = Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitZ()).matrix();
  EXPECT_TRUE(looks.next(pose, config));
}

}  // namespace
}  // namespace ovimap
