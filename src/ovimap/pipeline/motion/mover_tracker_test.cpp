// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/motion/mover_tracker.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

MovingPatch patch_at(float x, float y, float half_m = 0.2f) {
  MovingPatch patch;
  patch.area_px = 100;
  patch.centroid = {x, y, 1};
  patch.box = {patch.centroid.array() - half_m, patch.centroid.array() + half_m};
  return patch;
}

TEST(MoverTracker, TwoThatCrossKeepTheirNumbers) {
  MoverTracker tracker{MotionConfig{}};
  for (int i = 0; i < 40; ++i) {
    const float way = 0.05f * static_cast<float>(i);
    // In the order in which the image shows them, which changes where they cross.
    std::vector<MovingPatch> patches{patch_at(way, 0), patch_at(2 - way, 0.9f)};
    if (way > 1) std::swap(patches[0], patches[1]);
    tracker.add(patches, i / 30., i);
  }
  ASSERT_EQ(tracker.movers().size(), 2u);
  EXPECT_EQ(tracker.movers()[0].id, 1);
  EXPECT_NEAR(tracker.movers()[0].path.back().place.x(), 1.95f, 1e-4f);
  EXPECT_NEAR(tracker.movers()[1].path.back().place.x(), 0.05f, 1e-4f);
  EXPECT_EQ(tracker.movers()[1].path.size(), 40u);
}

TEST(MoverTracker, PatchesNearEachOtherAreOneThing) {
  MoverTracker tracker{MotionConfig{}};
  const std::vector<MovingPatch> patches{patch_at(0, 0), patch_at(3, 0), patch_at(0.5f, 0)};
  tracker.add(patches, 0, 0);
  ASSERT_EQ(tracker.movers().size(), 2u);
  EXPECT_NEAR(tracker.movers()[0].path[0].place.x(), 0.25f, 1e-5f);
  EXPECT_NEAR(tracker.movers()[0].size_m.x(), 0.9f, 1e-5f);
}

TEST(MoverTracker, WhatIsHiddenForAMomentIsTheSameAndForLongAnother) {
  MoverTracker tracker{MotionConfig{}};
  const std::vector<MovingPatch> here{patch_at(0, 0)};
  tracker.add(here, 0, 0);
  tracker.add({}, 0.5, 15);
  tracker.add(here, 1, 30);
  EXPECT_EQ(tracker.movers().size(), 1u);
  tracker.add(here, 4, 120);
  EXPECT_EQ(tracker.movers().size(), 2u);
}

TEST(MoverTracker, GoesOnFromWhatIsStored) {
  MoverTracker all{MotionConfig{}}, again{MotionConfig{}};
  std::vector<FrameLogEntry> log;
  const auto add = [&](MoverTracker& tracker, int i) {
    const std::vector<MovingPatch> patches{patch_at(0.08f * static_cast<float>(i), 0),
                                           patch_at(2, 2)};
    tracker.add(patches, i / 30., i);
  };
  for (int i = 0; i < 10; ++i) {
    add(all, i);
    log.push_back({i, i / 30., "", Pose::Identity(), false});
  }
  again.restore(all.movers(), log);
  for (int i = 10; i < 20; ++i) {
    add(all, i);
    add(again, i);
  }
  EXPECT_EQ(all.movers(), again.movers());
}

}  // namespace
}  // namespace ovimap
