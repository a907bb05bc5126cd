// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/views/view_selection.h"

#include <cmath>

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"

namespace ovimap {
namespace {

/// A ball of radius 0.5 (instance 1) at the world's origin, seen by a camera that looks at it from
/// any side.
class BallViews {
 public:
  BallViews() {
    InstanceRegistry::State state;
    state.super_points = {{1, {10, {{1, 10}}, FrameRuns({{0, 10}})}},
                          {2, {1, {{2, 1}}, FrameRuns({{0, 1}})}}};
    state.last_id = 2;
    registry.restore(state);
  }

  /// The camera's azimuth in degrees and distance in metres.
  std::vector<ChosenView> look(ViewSelector& selector, float azimuth, float distance = 2.f) {
    const float angle = azimuth * static_cast<float>(M_PI) / 180.f;
    const Eigen::Vector3f eye = distance * Eigen::Vector3f(std::cos(angle), std::sin(angle), 0);
    const Eigen::Vector3f forward = -eye.normalized(), down(0, 0, -1);
    Eigen::Matrix3f rotation;
    rotation << down.cross(forward), down, forward;
    DepthImage depth(kCamera.width, kCamera.height);
    Image<InstanceId> instances(kCamera.width, kCamera.height);
    for (int y = 0; y < kCamera.height; ++y)
      for (int x = 0; x < kCamera.width; ++x) {
        const Eigen::Vector3f ray =
            rotation * kCamera.unproject(static_cast<float>(x), static_cast<float>(y), 1.f);
        const float a = ray.squaredNorm(), b = eye.dot(ray), c = eye.squaredNorm() - 0.25f;
        if (b * b < a * c) continue;
        depth.at(x, y) = (-b - std::sqrt(b * b - a * c)) / a;
        instances.at(x, y) = id;
      }
    Pose pose = Pose::Identity();
    pose.linear() = rotation.cast<double>();
    pose.translation() = eye.cast<double>();
    Image<std::int32_t> color(kCamera.width, kCamera.height);
    for (int y = 0; y < kCamera.height; ++y)
      for (int x = 0; x < colorless_columns; ++x) color.at(x, y) = -1;
    // Super-points are called as their instances here.
    std::vector<ChosenView> chosen =
        selector.select({depth, instances, instances, blind ? DepthImage(160, 120) : depth, color,
                         kCamera, pose, frame++},
                        registry, looks);
    if (pictured)
      for (const ChosenView& view : chosen) ViewSelector::commit(view, {}, looks);
    return chosen;
  }

  InstanceId id = 1;
  bool blind = false;
  int colorless_columns = 0;  ///< at the left, where the colour image does not reach
  bool pictured = true;       ///< chosen views are kept
  std::int64_t frame = 0;
  InstanceRegistry registry;
  SuperPointLooks looks;

 private:
  static constexpr PinholeCamera kCamera{160, 120, 150, 150, 79.5f, 59.5f};
};

TEST(ViewSelection, TakesViewsThatShowNewSurface) {
  BallViews ball;
  ViewSelector selector(view_preset("default"));
  EXPECT_EQ(ball.look(selector, 0).size(), 1u);
  EXPECT_TRUE(ball.look(selector, 0).empty());  // the same again
  EXPECT_TRUE(ball.look(selector, 2).empty());  // hardly anything new
  EXPECT_EQ(ball.look(selector, 90).size(), 1u);
  EXPECT_EQ(ball.look(selector, 180).size(), 1u);
  const SuperPointLook& appearance = ball.looks.at(1);
  EXPECT_EQ(appearance.offered, 5);
  EXPECT_EQ(appearance.queries, 3);
  ASSERT_EQ(appearance.views.size(), 3u);
  EXPECT_EQ(appearance.views[1].frame, 3);
  EXPECT_EQ(appearance.views[1].embedding.size(), 0);
}

TEST(ViewSelection, NeedsFewViewsForAWholeCircle) {
  BallViews ball;
  ViewSelector selector(view_preset("default"));
  for (int azimuth = 0; azimuth < 720; azimuth += 5)
    ball.look(selector, static_cast<float>(azimuth));
  EXPECT_GE(ball.looks.at(1).queries, 4);
  EXPECT_LE(ball.looks.at(1).queries, 12);
}

TEST(ViewSelection, ComesCloser) {
  BallViews ball;
  ViewSelectionConfig config;
  ViewSelector selector(config);
  EXPECT_EQ(ball.look(selector, 0, 4.f).size(), 1u);
  EXPECT_EQ(ball.look(selector, 0, 2.f).size(), 1u);  // four times as many pixels
  config.better_ratio = 0;
  config.theta_novel = 0.3f;
  ViewSelector strict(config);
  BallViews again;
  EXPECT_EQ(again.look(strict, 0, 4.f).size(), 1u);
  EXPECT_TRUE(again.look(strict, 0, 2.5f).empty());
}

TEST(ViewSelection, PassesOverSmallUnmeasuredAndUnsureObjects) {
  BallViews ball;
  ViewSelectionConfig config;
  ViewSelector selector(config);
  EXPECT_TRUE(ball.look(selector, 0, 12.f).empty());  // too small
  ball.blind = true;
  EXPECT_TRUE(ball.look(selector, 0).empty());  // nothing measured there
  ball.blind = false;
  ball.id = 2;
  EXPECT_TRUE(ball.look(selector, 0).empty());  // seen in one frame so far
  ball.id = 3;
  EXPECT_TRUE(ball.look(selector, 0).empty());  // unknown to the registry
  EXPECT_TRUE(ball.looks.empty());
}

TEST(ViewSelection, CombineWantsLargeAndNew) {
  BallViews ball;
  ViewSelectionConfig config = view_preset("combine");
  config.min_mask_px = 100;
  config.min_first_depth_px = 100;
  config.top_views = 2;
  ViewSelector selector(config);
  EXPECT_EQ(ball.look(selector, 0).size(), 1u);
  EXPECT_EQ(ball.look(selector, 90).size(), 1u);
  EXPECT_TRUE(ball.look(selector, 180, 4.f).empty());  // new but smaller than both
  EXPECT_EQ(ball.look(selector, 180, 1.8f).size(), 1u);
}

TEST(ViewSelection, CombineComparesWithTheLargestNotWithAllThatAreKept) {
  BallViews ball;
  ViewSelectionConfig config = view_preset("combine");
  config.min_mask_px = config.min_first_depth_px = 100;
  config.top_views = 2;
  config.better_ratio = 0.01f;  // every view counts as new
  ViewSelector selector(config);
  for (const float distance : {2.f, 1.9f, 1.8f, 1.7f})
    EXPECT_EQ(ball.look(selector, 0, distance).size(), 1u) << distance;
  EXPECT_TRUE(ball.look(selector, 0, 1.85f).empty())
      << "larger than the first, but not among the two largest";
}

TEST(ViewSelection, TheGridMayFollowTheImage) {
  BallViews ball;  // 160 x 120 pixels
  ViewSelectionConfig config;
  config.grid_px_per_bin = 8;
  ViewSelector selector(config);
  ASSERT_EQ(ball.look(selector, 0).size(), 1u);
  EXPECT_EQ(ball.looks.at(1).views.front().directions.bins.words().size(),
            BinSet(15 * 20).words().size());
}

TEST(ViewSelection, PixelsKeepsTheLargest) {
  BallViews ball;
  ViewSelectionConfig config = view_preset("vis");
  config.min_mask_px = 100;
  config.min_first_depth_px = 100;
  config.top_views = 2;
  ViewSelector selector(config);
  for (const float distance : {3.f, 2.5f, 2.f, 4.f}) ball.look(selector, 0, distance);
  const SuperPointLook& appearance = ball.looks.at(1);
  EXPECT_EQ(appearance.queries, 3);
  ASSERT_EQ(appearance.views.size(), 2u);
  EXPECT_EQ(appearance.views[0].frame, 1);
  EXPECT_EQ(appearance.views[1].frame, 2);
}

TEST(ViewSelection, RandomDrawsEveryViewAlike) {
  std::vector<int> kept(30);
  constexpr int kSeeds = 200;
  for (int seed = 0; seed < kSeeds; ++seed) {
    BallViews ball;
    ViewSelectionConfig config = view_preset("random");
    config.random_seed = seed;
    ViewSelector selector(config);
    for (int i = 0; i < 30; ++i) ball.look(selector, static_cast<float>(i), 1.5f);
    ASSERT_EQ(ball.looks.at(1).views.size(), 8u);
    for (const ObjectView& view : ball.looks.at(1).views)
      ++kept[static_cast<std::size_t>(view.frame)];
  }
  // Each of 30 views stays with probability 8 / 30: 53 of 200, with deviation 6.3.
  for (const int count : kept) EXPECT_NEAR(count, kSeeds * 8 / 30, 30);
}

TEST(ViewSelection, AllTakesAll) {
  BallViews ball;
  ViewSelector selector(view_preset("all"));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(ball.look(selector, 0, 1.5f).size(), 1u);
}

TEST(ViewSelection, StartsAnewWhenAnObjectTurnsOutLarger) {
  BallViews ball;
  ViewSelector selector(view_preset("default"));
  ball.look(selector, 0);
  SuperPointLook& look = ball.looks.at(1);
  look.seen_in_world.extend(Eigen::Vector3f(5, 5, 5));  // as another view found
  EXPECT_EQ(ball.look(selector, 0).size(), 1u);
  EXPECT_GT(
      (look.views[1].directions.center_in_world - look.views[0].directions.center_in_world).norm(),
      1.f);
}

TEST(ViewSelection, WhatOnlyColourDoesNotShowIsNeitherWeighedNorCovered) {
  BallViews whole, half;
  ViewSelector selector(view_preset("default"));
  half.colorless_columns = 80;  // half of the ball
  const auto all = whole.look(selector, 0), part = half.look(selector, 0);
  ASSERT_EQ(part.size(), 1u);
  EXPECT_NEAR(part[0].view.visible_px, all[0].view.visible_px / 2, 100);
  const int seen = all[0].view.directions.bins.count();
  EXPECT_LT(part[0].view.directions.bins.count(), 0.8 * seen) << "the halves share bins";
  half.colorless_columns = 0;
  EXPECT_EQ(half.look(selector, 0).size(), 1u) << "the other half is still to be shown";
  BallViews none;
  none.colorless_columns = 160;
  EXPECT_TRUE(none.look(selector, 0).empty());
  EXPECT_TRUE(none.looks.empty());
}

TEST(ViewSelection, AViewWithoutPictureCoversNothing) {
  BallViews ball;
  ViewSelector selector(view_preset("default"));
  ball.pictured = false;
  EXPECT_EQ(ball.look(selector, 0).size(), 1u);
  EXPECT_EQ(ball.look(selector, 0).size(), 1u) << "it is still to be shown";
  EXPECT_EQ(ball.looks.at(1).queries, 0);
  ball.pictured = true;
  ball.look(selector, 0);
  EXPECT_TRUE(ball.look(selector, 0).empty());
}

/// A wall two metres ahead: super-point 1 on the left, 2 on the right of column 40 of 120.
class WallView {
 public:
  WallView() : depth_(120, 90, 2.f), labels_(120, 90, 2u), color_(120, 90) {
    for (int y = 0; y < 90; ++y)
      for (int x = 0; x < 40; ++x) labels_.at(x, y) = 1;
  }

  /// How many views are chosen when the wall is one object, or each part one.
  std::size_t look(bool one_object) {
    InstanceRegistry::State state;
    state.super_points = {{1, {9, {{1, 9}}, FrameRuns({{0, 9}})}},
                          {2, {9, {{2, 9}}, FrameRuns({{0, 9}})}}};
    if (one_object) state.aliases = {{2, 1}};
    InstanceRegistry registry;
    registry.restore(state);
    Image<InstanceId> ids(120, 90);
    for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = registry.instance_of(labels_[i]);
    auto chosen = selector_.select({depth_,
                                    ids,
                                    labels_,
                                    depth_,
                                    color_,
                                    {120, 90, 100, 100, 59.5f, 44.5f},
                                    Pose::Identity(),
                                    frame_++},
                                   registry, looks);
    for (const ChosenView& view : chosen) ViewSelector::commit(view, {}, looks);
    return chosen.size();
  }

  SuperPointLooks looks;

 private:
  ViewSelector selector_{view_preset("default")};
  DepthImage depth_;
  Image<Label> labels_;
  Image<std::int32_t> color_;
  std::int64_t frame_ = 0;
};

TEST(ViewSelection, AViewBelongsToTheSuperPointThatCoversMostOfIt) {
  WallView wall;
  EXPECT_EQ(wall.look(true), 1u);
  EXPECT_EQ(wall.looks.at(2).views.size(), 1u);
  EXPECT_EQ(wall.looks.at(2).queries, 1);
  EXPECT_TRUE(wall.looks.at(1).views.empty());
  EXPECT_FALSE(wall.looks.at(1).seen_in_world.isEmpty()) << "its surface was seen all the same";
  EXPECT_LT(wall.looks.at(1).seen_in_world.max().x(), wall.looks.at(2).seen_in_world.min().x());
}

TEST(ViewSelection, PartsOfAnObjectThatFellApartAreLookedAtAndThenKnown) {
  WallView wall;
  EXPECT_EQ(wall.look(true), 1u);
  EXPECT_EQ(wall.look(true), 0u);
  EXPECT_EQ(wall.look(false), 1u) << "most of the view of the whole was the other part";
  EXPECT_EQ(wall.looks.at(1).views.size(), 1u);
  EXPECT_EQ(wall.looks.at(2).views.size(), 1u);
  EXPECT_EQ(wall.look(false), 0u);
  EXPECT_EQ(wall.look(true), 0u) << "the whole has been shown before";
}

TEST(ViewSelection, DoesNotDependOnThreads) {
  std::vector<std::vector<std::int64_t>> frames;
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    BallViews ball;
    ViewSelector selector(view_preset("default"));
    for (int azimuth = 0; azimuth < 360; azimuth += 7)
      ball.look(selector, static_cast<float>(azimuth));
    auto& list = frames.emplace_back();
    for (const ObjectView& view : ball.looks.at(1).views) list.push_back(view.frame);
  }
  EXPECT_EQ(frames[0], frames[1]);
}

TEST(ViewSelection, KnowsItsPresets) {
  EXPECT_EQ(view_preset("paper").grid_columns, 240);
  EXPECT_EQ(view_preset("paper").grid_px_per_bin, 0);
  for (const char* name : {"viewcov", "combine", "vis"})
    EXPECT_EQ(view_preset(name).grid_px_per_bin, 8) << name;
  EXPECT_EQ(view_preset("viewcov").min_mask_px, 1000);
  EXPECT_THROW(view_preset("best"), Error);
}

}  // namespace
}  // namespace ovimap
