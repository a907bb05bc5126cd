// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/fusion/seen_free.h"

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"
#include "ovimap/map/fusion/plain_seen_free.h"

namespace ovimap {
namespace {

constexpr float kCell_m = 0.08f;
const PinholeCamera kCamera{160, 120, 150.f, 150.f, 79.5f, 59.5f};

Pose some_pose(int i) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(0.7 * i, Eigen::Vector3d(1, 2, 0.5).normalized()).matrix();
  pose.translation() << 0.3 * i, -0.2, 0.1 * i;
  return pose;
}

/// Free to 2.5 m, with a nearer box and a hole.
Image<float> some_free_depth() {
  Image<float> free_m(kCamera.width, kCamera.height, 2.5f);
  for (int y = 30; y < 70; ++y)
    for (int x = 40; x < 90; ++x) free_m.at(x, y) = 1.1f;
  for (int y = 90; y < 95; ++y)
    for (int x = 120; x < 125; ++x) free_m.at(x, y) = 0.f;
  return free_m;
}

TEST(SeenFree, LooksThroughWhatThePlainWayLooksThrough) {
  const Image<float> free_m = some_free_depth();
  for (int i = 0; i < 4; ++i) {
    const Pose pose = some_pose(i);
    SeenFree space;
    space.look(kCamera, pose, free_m, kCell_m);
    const Eigen::Vector3d eye = pose.translation() / static_cast<double>(kCell_m);
    int through = 0;
    for (int z = -34; z <= 34; ++z)
      for (int y = -34; y <= 34; ++y)
        for (int x = -34; x <= 34; ++x) {
          const BlockIndex cell = eye.array().floor().matrix().cast<int>() + BlockIndex(x, y, z);
          const bool plain = plain::looks_through(kCamera, pose, free_m, cell, kCell_m);
          ASSERT_EQ(space.at(cell).looks, plain) << cell.transpose() << " from pose " << i;
          through += plain;
        }
    EXPECT_GT(through, 2000);
    std::size_t all = 0;
    for (const auto& [key, region] : space.regions())
      for (const SpaceCell& seen : region) all += seen.looks;
    EXPECT_EQ(all, static_cast<std::size_t>(through)) << "nothing beyond that";
  }
}

TEST(SeenFree, IsTheSameForEveryNumberOfThreads) {
  SeenFree one, many;
  for (int i = 0; i < 3; ++i) {
    many.look(kCamera, some_pose(i), some_free_depth(), kCell_m);
    const ThreadLimit limit(1);
    one.look(kCamera, some_pose(i), some_free_depth(), kCell_m);
  }
  EXPECT_EQ(one.regions(), many.regions());
}

TEST(SeenFree, WhatStaysLongEnoughOnEndIsSeenEmptyNoMore) {
  const Image<float> free_m(kCamera.width, kCamera.height, 2.5f);
  const std::vector<BlockIndex> cells{BlockIndex(0, 0, 12)};
  SeenFree space;
  for (int i = 0; i < 6; ++i) space.look(kCamera, Pose::Identity(), free_m, kCell_m);
  ASSERT_EQ(space.at(cells[0]).looks, 6);
  space.take(cells, 20, 45);
  space.take(cells, 20, 45);
  EXPECT_EQ(space.at(cells[0]).looks, 6) << "not yet";
  space.look(kCamera, Pose::Identity(), free_m, kCell_m);
  EXPECT_EQ(space.at(cells[0]), (SpaceCell{7, 0})) << "it had left";
  space.take(cells, 20, 45);
  space.take(cells, 25, 45);
  EXPECT_EQ(space.at(cells[0]), SpaceCell{});
  space.take(std::vector<BlockIndex>{BlockIndex(500, 0, 0)}, 20, 45);
  EXPECT_EQ(space.at({500, 0, 0}), SpaceCell{}) << "nobody looked there";
}

TEST(SeenFree, WhatIsSuspectIsSoUntilItHasStoodForLong) {
  SeenFree space;
  const std::vector<BlockIndex> cells{{-1, 5, 20}, {9, 0, -4}};
  for (const BlockIndex& cell : cells) space.suspect(cell);
  EXPECT_EQ(space.suspects().size(), 2u);
  space.stand(std::vector<BlockIndex>{cells[1]}, 20, 30);
  EXPECT_EQ(space.suspects().size(), 2u);
  space.stand(std::vector<BlockIndex>{cells[1]}, 20, 30);
  EXPECT_EQ(space.suspects(), std::vector<BlockIndex>{cells[0]});
  EXPECT_EQ(space.at(cells[1]), (SpaceCell{0, 40}));
  for (int i = 0; i < 20; ++i) space.stand(std::vector<BlockIndex>{cells[1]}, 20, 30);
  EXPECT_EQ(space.at(cells[1]).taken, SpaceCell::kMost);
}

TEST(SeenFree, CountsNoFurtherThanItCan) {
  const Image<float> free_m(kCamera.width, kCamera.height, 2.5f);
  SeenFree space;
  for (int i = 0; i < 260; ++i) space.look(kCamera, Pose::Identity(), free_m, kCell_m);
  EXPECT_EQ(space.at({0, 0, 12}).looks, SpaceCell::kMost);
}

}  // namespace
}  // namespace ovimap
