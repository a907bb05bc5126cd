// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/motion/motion_filter.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"
#include "ovimap/map/rays/surface_lookup.h"

namespace ovimap {
namespace {

constexpr float kWall_m = 3.f, kBox_m = 1.8f, kPost_m = 2.f;

/// A wall across the view, a camera that sways before it, and a box that may stand in between.
class Scene {
 public:
  explicit Scene(const MotionConfig& config = {}) : filter(config) {}

  /// The next frame; the box is `half_px` large to either side of that column, 0: away.
  MovingPixels frame(int column, int half_px) {
    depth.fill(kWall_m);
    for (int y = 60 - half_px; y < 60 + half_px; ++y)
      for (int x = std::max(column - half_px, 0); x < std::min(column + half_px, 160); ++x)
        depth.at(x, y) = kBox_m;
    return see();
  }
  MovingPixels see() {
    pose.translation().x() = number % 2 == 0 ? 0. : 0.06;
    const Observation seen{.depth = depth,
                           .camera = camera,
                           .world_from_camera = pose,
                           .plane_slope = &slope,
                           .sigma_m = &sigma};
    const double now_s = static_cast<double>(number) / 30;
    MovingPixels moving = filter.see(map, seen, taken_out, {}, now_s, number);
    filter.take_back(map, seen, moving, {});
    log.push_back({number, now_s, "", pose, false});
    ++number;
    const DepthImage still = still_depth(depth, moving.ids);
    integrate(map, {.depth = still,
                    .camera = camera,
                    .world_from_camera = pose,
                    .plane_slope = &slope,
                    .sigma_m = &sigma});
    return moving;
  }
  /// The next frame, in which nobody can see how deep it is below the middle; or a post stands
  /// there, or a box at the middle.
  MovingPixels frame_below(bool post, bool box) {
    depth.fill(kWall_m);
    for (int y = 75; y < 105; ++y)
      for (int x = 70; x < 90; ++x) depth.at(x, y) = post ? kPost_m : 0.f;
    for (int y = 45; y < 75 && box; ++y)
      for (int x = 65; x < 95; ++x) depth.at(x, y) = kBox_m;
    return see();
  }
  /// Whether the map has surface where the post shows its middle.
  bool has_post() const {
    VoxelFinder finder(map);
    const Eigen::Vector3f middle = camera.unproject(80, 90, kPost_m);
    return finder.seek(middle) && finder.observed();
  }
  void watch(int frames) {
    for (int i = 0; i < frames; ++i) frame(80, 0);
  }

  PinholeCamera camera{160, 120, 150.f, 150.f, 79.5f, 59.5f};
  DepthImage depth{160, 120, kWall_m}, taken_out;
  Image<float> slope{160, 120, 1.f}, sigma{160, 120, 0.002f};
  Pose pose = Pose::Identity();
  VoxelMap map;
  MotionFilter filter;
  std::int64_t number = 0;
  std::vector<FrameLogEntry> log;
};

std::ptrdiff_t moving_px(const MovingPixels& moving) {
  return std::count_if(moving.ids.begin(), moving.ids.end(), [](auto id) { return id != 0; });
}

TEST(MotionFilter, SeesABoxThatComesIntoSpaceThatWasSeenEmpty) {
  Scene scene;
  scene.watch(10);
  const MovingPixels moving = scene.frame(80, 15);
  ASSERT_EQ(moving.patches.size(), 1u);
  EXPECT_GE(moving_px(moving), 30 * 30) << "all of it";
  EXPECT_LE(moving_px(moving), 36 * 36) << "and what lies around it by a few pixels";
  EXPECT_NEAR(moving.patches[0].centroid.z(), kBox_m, 0.01f);
  EXPECT_FALSE(moving.refused);
}

TEST(MotionFilter, WhatWasThereFromTheFirstFrameStands) {
  Scene scene;
  for (int i = 0; i < 20; ++i) EXPECT_EQ(moving_px(scene.frame(80, 15)), 0) << i;
}

TEST(MotionFilter, TooFewLooksSayNothing) {
  Scene scene;
  scene.watch(MotionConfig{}.looks - 1);
  EXPECT_EQ(moving_px(scene.frame(80, 15)), 0);
}

TEST(MotionFilter, HolesAndGrazingRaysAreNoLooks) {
  Scene holes, grazing;
  grazing.slope.fill(0.1f);
  for (int i = 0; i < 20; ++i) {
    holes.depth.fill(kWall_m);
    for (std::size_t k = 0; k < holes.depth.size(); k += 5) holes.depth[k] = 0.f;
    holes.see();
    grazing.frame(80, 0);
  }
  EXPECT_EQ(moving_px(holes.frame(80, 15)), 0);
  grazing.slope.fill(1.f);
  EXPECT_EQ(moving_px(grazing.frame(80, 15)), 0);
}

TEST(MotionFilter, NoiseAndSmallPatchesStand) {
  Scene scene;
  scene.watch(10);
  EXPECT_EQ(moving_px(scene.frame(80, 2)), 0) << "a patch of 4 x 4 pixels";
  scene.depth.fill(kWall_m - 0.02f);
  EXPECT_EQ(moving_px(scene.see()), 0) << "a wall that lies two centimetres off";
  scene.sigma.fill(0.3f);
  EXPECT_EQ(moving_px(scene.frame(80, 15)), 0) << "depth that errs by that much";
}

TEST(MotionFilter, AFrameThatContradictsMoreThanItConfirmsIsRefused) {
  Scene scene;
  scene.watch(10);
  scene.depth.fill(kWall_m + 1.f);
  for (int y = 0; y < 120; ++y)
    for (int x = 35; x < 125; ++x) scene.depth.at(x, y) = 1.5f;
  const MovingPixels moving = scene.see();
  EXPECT_TRUE(moving.refused);
  EXPECT_TRUE(moving.ids.empty());
}

TEST(MotionFilter, AHandOnTheLensIsLeftOut) {
  Scene scene;
  scene.watch(10);
  scene.depth.fill(0.f);  // too near for the sensor
  for (int y = 30; y < 90; ++y)
    for (int x = 40; x < 120; ++x) scene.depth.at(x, y) = 0.7f;
  const MovingPixels moving = scene.see();
  EXPECT_FALSE(moving.refused);
  const DepthImage left = still_depth(scene.depth, moving.ids);
  EXPECT_EQ(std::count(left.begin(), left.end(), 0.f), 160 * 120) << "nothing of it is left";
}

TEST(MotionFilter, WhatStaysIsPartOfThePlaceAfterAWhile) {
  Scene scene;
  scene.watch(10);
  int moved = 0;
  for (int i = 0; i < 60; ++i) moved += moving_px(scene.frame(80, 15)) > 0;
  const int stays = static_cast<int>(MotionConfig{}.stays_s * 30);
  EXPECT_GE(moved, stays - 1);
  EXPECT_LE(moved, stays + 3);
}

TEST(MotionFilter, GoesOnFromWhatIsStoredAsIfNeverStopped) {
  MotionConfig config;
  config.mode = DynamicMode::kTrack;
  Scene all(config), again(config);
  for (Scene* scene : {&all, &again}) {  // of the same map
    scene->watch(10);
    for (int i = 0; i < 8; ++i) scene->frame(40 + 8 * i, 12);
  }
  again.filter = MotionFilter(config);
  again.filter.restore(all.filter.space(), all.filter.movers(), all.log);
  for (int i = 0; i < 5; ++i) {
    const MovingPixels a = all.frame(104 + 8 * i, 12), b = again.frame(104 + 8 * i, 12);
    EXPECT_EQ(a.cells, b.cells);
  }
  EXPECT_TRUE(all.filter.space().regions() == again.filter.space().regions());
  EXPECT_FALSE(all.filter.movers().empty());
  EXPECT_TRUE(all.filter.movers() == again.filter.movers());
}

TEST(MotionFilter, IsTheSameForEveryNumberOfThreads) {
  Scene one, many;
  for (int i = 0; i < 24; ++i) {
    const int half_px = i < 10 ? 0 : 14;
    const MovingPixels a = many.frame(30 + 4 * i, half_px);
    const ThreadLimit limit(1);
    const MovingPixels b = one.frame(30 + 4 * i, half_px);
    EXPECT_TRUE(std::equal(a.ids.begin(), a.ids.end(), b.ids.begin(), b.ids.end()));
  }
}

TEST(MotionFilter, WhatHangsBehindAThingThatMovesDoesToo) {
  MotionConfig apart;
  apart.behind_m = 0;
  Scene scene, other(apart);
  for (int i = 0; i < 10; ++i) scene.frame_below(false, false), other.frame_below(false, false);
  EXPECT_NE(scene.frame_below(true, true).ids.at(80, 95), 0);
  EXPECT_EQ(other.frame_below(true, true).ids.at(80, 95), 0) << "nobody had looked through there";
}

TEST(MotionFilter, TakesBackWhatWasFusedOfItBeforeItWasKnownToMove) {
  Scene scene;
  for (int i = 0; i < 10; ++i) scene.frame_below(false, false);
  for (int i = 0; i < 3; ++i) scene.frame_below(true, false);
  ASSERT_TRUE(scene.has_post());
  scene.frame_below(true, true);
  EXPECT_FALSE(scene.has_post());
}

TEST(MotionFilter, WhatHasBeenSeenForLongStaysBesideAThingThatMoves) {
  Scene scene;
  for (int i = 0; i < 10; ++i) scene.frame_below(false, false);
  for (int i = 0; i < 40; ++i) scene.frame_below(true, false);
  for (int i = 0; i < 5; ++i) scene.frame_below(true, true);
  EXPECT_TRUE(scene.has_post());
}

TEST(MotionFilter, WhatIsSuspectGoesAsSoonAsItIsSeenThrough) {
  Scene scene, still;
  for (Scene* each : {&scene, &still}) {
    for (int i = 0; i < 10; ++i) each->frame_below(false, false);
    for (int i = 0; i < 3; ++i) each->frame_below(true, false);
    each->filter = MotionFilter(MotionConfig{});
    SeenFree space;
    if (each == &scene)
      space.suspect(block_at(each->camera.unproject(80, 90, kPost_m),
                             1.f / each->map.config().block_size_m()));
    each->filter.restore(std::move(space), {}, {});
    each->frame(80, 0);
  }
  EXPECT_FALSE(scene.has_post());
  EXPECT_TRUE(still.has_post()) << "one look alone takes nothing else";
}

/// Somebody comes in whose upper half a filter takes out of each frame; the lower half shows where
/// nobody could look through before.
TEST(MotionFilter, WhatHangsTogetherWithWhatWasTakenOutMovesAsIfNothingWas) {
  Scene whole, halved;
  for (Scene* scene : {&whole, &halved})
    for (int i = 0; i < 10; ++i) scene->frame_below(false, false);
  halved.taken_out = DepthImage(160, 120);
  for (int y = 45; y < 75; ++y)
    for (int x = 65; x < 95; ++x) halved.taken_out.at(x, y) = kBox_m;
  const MovingPixels a = whole.frame_below(true, true), b = halved.frame_below(true, true);
  EXPECT_NE(b.ids.at(80, 95), 0);
  EXPECT_TRUE(a.ids == b.ids);
  EXPECT_FALSE(halved.has_post());
}

TEST(MotionFilter, WhatWasTakenOutNeverStands) {
  Scene scene;
  scene.taken_out = DepthImage(160, 120);
  for (int y = 75; y < 105; ++y)
    for (int x = 70; x < 90; ++x) scene.taken_out.at(x, y) = kPost_m;
  for (int i = 0; i < 60; ++i)
    EXPECT_EQ(scene.frame_below(true, false).ids.at(80, 90), MovingPixels::kTakenOut);
  EXPECT_FALSE(scene.has_post());
  const BlockIndex cell =
      block_at(scene.camera.unproject(80, 90, kPost_m), 1.f / scene.map.config().block_size_m());
  EXPECT_EQ(scene.filter.space().at(cell).taken, 0);
}

TEST(MotionFilter, OffSeesNothingAndRemembersNothing) {
  MotionConfig config;
  config.mode = DynamicMode::kOff;
  Scene scene(config);
  scene.watch(10);
  EXPECT_EQ(moving_px(scene.frame(80, 15)), 0);
  EXPECT_TRUE(scene.filter.space().regions().empty());
}

TEST(StillSegments, LeaveOutWhatMovesAndNumberTheRestAnew) {
  Segments segments{IdImage(6, 1), {{7, 2}, {8, 3}, {9, 1}}};
  const std::uint16_t ids[] = {1, 1, 2, 2, 2, 3}, moves[] = {1, 1, 0, 0, 1, 0};
  IdImage moving(6, 1);
  std::copy_n(ids, 6, segments.ids.begin());
  std::copy_n(moves, 6, moving.begin());
  const Segments still = still_segments(segments, moving);
  const std::uint16_t left[] = {0, 0, 1, 1, 0, 2};
  EXPECT_TRUE(std::equal(std::begin(left), std::end(left), still.ids.begin()));
  ASSERT_EQ(still.segments.size(), 2u);
  EXPECT_EQ(still.segments[0].entity, 8);
  EXPECT_EQ(still.segments[0].area_px, 2);
  EXPECT_EQ(still.segments[1].entity, 9);
}

}  // namespace
}  // namespace ovimap
