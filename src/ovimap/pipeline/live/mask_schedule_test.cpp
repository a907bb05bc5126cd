// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/live/mask_schedule.h"

#include <gtest/gtest.h>

#include "ovimap/pipeline/mapping/desk_fixture.h"
#include "ovimap/pipeline/mapping/mapper.h"

namespace ovimap {
namespace {

TEST(UnexplainedShare, FallsOnceTheSurfaceHasLabels) {
  const DeskScene scene;
  const Frame frame = *scene.read(0).frame;
  EXPECT_EQ(unexplained_share(VoxelMap(), frame), 1.f);
  MapperConfig config;
  config.mask_interval = 2;
  Mapper mapper(config, std::make_shared<DeskMasks>());
  mapper.process(frame);
  EXPECT_LT(unexplained_share(mapper.map(), frame), 0.2f);
  EXPECT_GT(unexplained_share(mapper.map(), *scene.read(6).frame), 0.2f) << "the other side";
}

TEST(MaskSchedule, IntervalCountsFrames) {
  const DeskScene scene;
  const VoxelMap map;
  MaskSchedule schedule({.rule = MaskRule::kInterval, .interval = 3});
  for (int i = 0; i < 9; ++i) {
    const Frame frame = *scene.read(0).frame;
    const bool wanted = schedule.wants(frame, map);
    EXPECT_EQ(wanted, i % 3 == 0) << i;
    if (wanted) schedule.chosen();
  }
}

TEST(MaskSchedule, AWishThatWasNotMetStays) {
  const DeskScene scene;
  const VoxelMap map;
  MaskSchedule schedule({.rule = MaskRule::kInterval, .interval = 3});
  const Frame frame = *scene.read(0).frame;
  EXPECT_TRUE(schedule.wants(frame, map));
  EXPECT_TRUE(schedule.wants(frame, map)) << "none was chosen yet";
}

TEST(MaskSchedule, WhatWentWithoutIsStillNeeded) {
  const DeskScene scene;
  const VoxelMap map;
  const Frame frame = *scene.read(0).frame;
  MaskSchedule need({.min_gap = 100}), interval({.rule = MaskRule::kInterval, .interval = 3});
  for (MaskSchedule* schedule : {&need, &interval}) {
    ASSERT_TRUE(schedule->wants(frame, map));
    schedule->chosen();
    schedule->went_without();
  }
  EXPECT_TRUE(need.wants(frame, map));
  EXPECT_FALSE(interval.wants(frame, map)) << "a fixed rhythm stays";
}

TEST(MaskSchedule, NeedLooksAgainAfterMotionAndNotBefore) {
  const DeskScene scene;
  Frame frame = *scene.read(0).frame;
  MapperConfig config;
  Mapper mapper(config, std::make_shared<DeskMasks>());
  mapper.process(frame);
  MaskSchedule schedule({.unexplained_share = 0.5f, .motion = 0.1f, .min_gap = 2});
  ASSERT_TRUE(schedule.wants(frame, mapper.map())) << "the first frame";
  schedule.chosen();
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(schedule.wants(frame, mapper.map())) << "nothing new";
  frame.world_from_camera.translation().x() += 0.3;
  EXPECT_TRUE(schedule.wants(frame, mapper.map()));
  schedule.chosen();
  frame.world_from_camera.translation().x() += 0.3;
  EXPECT_FALSE(schedule.wants(frame, mapper.map())) << "too soon";
  EXPECT_TRUE(schedule.wants(frame, mapper.map()));
}

}  // namespace
}  // namespace ovimap
