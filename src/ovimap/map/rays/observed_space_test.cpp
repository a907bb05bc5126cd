// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/rays/observed_space.h"

#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "ovimap/map/rays/sphere_fixture.h"

namespace ovimap {
namespace {

/// Asks every view.
int seen_by_all(const ObservedSpace& space, const Eigen::Vector3f& point, int enough = 1) {
  std::vector<std::uint32_t> all(space.views());
  std::iota(all.begin(), all.end(), 0u);
  return space.seen_through(point, all, enough);
}

class ObservedSpaceTest : public ::testing::Test {
 protected:
  ObservedSpaceTest() { scene_.integrate_views(map_, 4, 1); }
  const SphereScene scene_;
  VoxelMap map_;
};

TEST_F(ObservedSpaceTest, IsWhatLiesBeforeTheSurface) {
  const std::vector<Pose> poses = {scene_.pose(0.)};  // at z = -1.2, looking along +z
  const ObservedSpace space(map_, scene_.camera, poses);
  EXPECT_EQ(space.views(), 1u);
  EXPECT_EQ(seen_by_all(space, {0.f, 0.f, -0.7f}), 1);
  EXPECT_EQ(seen_by_all(space, {0.f, 0.f, -0.31f}), 0);   // too near to the surface to be sure
  EXPECT_EQ(seen_by_all(space, {0.f, 0.f, 0.f}), 0);      // within the sphere
  EXPECT_EQ(seen_by_all(space, {0.f, 0.f, 0.7f}), 0);     // behind it
  EXPECT_EQ(seen_by_all(space, {0.f, 0.f, -1.5f}), 0);    // behind the camera
  EXPECT_EQ(seen_by_all(space, {0.38f, 0.f, -0.1f}), 0);  // beside it: that ray met nothing
  EXPECT_EQ(seen_by_all(space, {9.f, 0.f, 0.f}), 0);      // outside the picture
}

TEST_F(ObservedSpaceTest, CountsViews) {
  std::vector<Pose> poses;
  for (int i = 0; i < 12; ++i) poses.push_back(scene_.pose(0.02 * i));
  const ObservedSpace space(map_, scene_.camera, poses);
  EXPECT_EQ(seen_by_all(space, {0.f, 0.f, -0.6f}, 100), 12);
  EXPECT_EQ(seen_by_all(space, {0.f, 0.f, -0.6f}, 5), 5);
  ObservedSpaceConfig few;
  few.max_views = 3;
  EXPECT_EQ(ObservedSpace(map_, scene_.camera, poses, few).views(), 3u);
}

TEST_F(ObservedSpaceTest, AsksOnlyTheViewsThatMatter) {
  std::vector<Pose> poses;
  for (int i = 0; i < 24; ++i) poses.push_back(scene_.pose(0.26 * i));
  const ObservedSpace space(map_, scene_.camera, poses);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-1.5f, 1.5f);
  constexpr float kRadius_m = 0.1f;
  std::size_t asked = 0, seen = 0;
  constexpr int kBalls = 500;
  for (int ball = 0; ball < kBalls; ++ball) {
    const Eigen::Vector3f center(place(random), place(random), place(random));
    const std::vector<std::uint32_t> views = space.views_into(center, kRadius_m);
    asked += views.size();
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3f aside =
          Eigen::Vector3f(place(random), place(random), place(random)).normalized();
      const Eigen::Vector3f point = center + kRadius_m * aside;
      const int all = seen_by_all(space, point, 100);
      EXPECT_EQ(space.seen_through(point, views, 100), all) << point.transpose();
      seen += all > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(seen, 100u);
  EXPECT_LT(asked, kBalls * poses.size() / 3);
}

TEST_F(ObservedSpaceTest, LooksMoreOftenInLargePlaces) {
  std::vector<Pose> poses(40, scene_.pose(0.));
  ObservedSpaceConfig config;
  config.max_views = 4;
  EXPECT_EQ(ObservedSpace(map_, scene_.camera, poses, config).views(), 4u);
  poses.back().translation() += Eigen::Vector3d(50., 0., 40.);  // five times 400 m2
  EXPECT_EQ(ObservedSpace(map_, scene_.camera, poses, config).views(), 20u);
}

TEST_F(ObservedSpaceTest, IsEmptyWithoutFrames) {
  EXPECT_EQ(seen_by_all(ObservedSpace(map_, scene_.camera, {}), {0.f, 0.f, -0.7f}), 0);
  const std::vector<Pose> poses = {scene_.pose(0.)};
  EXPECT_EQ(ObservedSpace(map_, PinholeCamera{}, poses).views(), 0u);
}

}  // namespace
}  // namespace ovimap
