// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/appearance.h"

#include <cmath>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

ObjectView view(std::int64_t frame, int visible_px, Eigen::Vector2f embedding = {1, 0}) {
  ObjectView result;
  result.frame = frame;
  result.visible_px = visible_px;
  result.embedding = embedding;
  return result;
}

ObjectView with_crop(ObjectView view) {
  view.crop.image_jpeg = {1, 2, 3};
  return view;
}

TEST(FuseViews, WeighsByPixels) {
  const std::vector<ObjectView> views = {view(1, 300, {1, 0}), view(2, 100, {0, 1})};
  const Eigen::VectorXf fused = fuse_views(views, FeatureFusion::kPixelWeighted);
  EXPECT_NEAR(fused.norm(), 1, 1e-6);
  EXPECT_NEAR(fused[0] / fused[1], 3, 1e-5);
  const Eigen::VectorXf mean = fuse_views(views, FeatureFusion::kMean);
  EXPECT_NEAR(mean[0], mean[1], 1e-6);
}

TEST(FuseViews, TakesTheViewMostLikeTheOthers) {
  const auto at = [](float degrees) {
    const float angle = degrees * static_cast<float>(M_PI) / 180.f;
    return Eigen::Vector2f(std::cos(angle), std::sin(angle));
  };
  const std::vector<ObjectView> views = {view(1, 9, at(0)), view(2, 9, at(20)), view(3, 9, at(30)),
                                         view(4, 9000, at(170))};
  // Mean cosines at 20 and 30 degrees: 0.353 and 0.362; mean L1 distances: 0.91 and 1.01.
  EXPECT_TRUE(fuse_views(views, FeatureFusion::kMaxCosine).isApprox(views[2].embedding, 1e-5f));
  EXPECT_TRUE(fuse_views(views, FeatureFusion::kMinL1).isApprox(views[1].embedding, 1e-5f));
}

TEST(FuseViews, MayTakeTheLargestAlone) {
  std::vector<ObjectView> views = {view(1, 5, {0, 1}), view(2, 9, {1, 0}), view(3, 7, {1, 0}),
                                   view(4, 5, {0, 1})};
  const auto east = Eigen::Vector2f(1, 0);
  EXPECT_TRUE(fuse_views(views, {FeatureFusion::kPixelWeighted, 2}).isApprox(east));
  EXPECT_TRUE(fuse_views(views, {FeatureFusion::kMean, 2}).isApprox(east));
  EXPECT_GT(fuse_views(views, {FeatureFusion::kMean, 3})[1], 0.1f);
  EXPECT_EQ(fuse_views(views, {FeatureFusion::kMean, 4}), fuse_views(views, FeatureFusion::kMean));
  EXPECT_EQ(fuse_views(views, {FeatureFusion::kMean, 0}), fuse_views(views, FeatureFusion::kMean));
  views[1].embedding = {};  // not answered: the next in size takes its place
  EXPECT_GT(fuse_views(views, {FeatureFusion::kMean, 2})[1], 0.1f);
}

TEST(FuseViews, PassesOverViewsWithoutAnswer) {
  std::vector<ObjectView> views = {view(1, 100, {0, 1}), view(2, 1000)};
  views[1].embedding = {};
  EXPECT_TRUE(fuse_views(views, FeatureFusion::kPixelWeighted).isApprox(Eigen::Vector2f(0, 1)));
  views[0].embedding = {};
  EXPECT_EQ(fuse_views(views, FeatureFusion::kPixelWeighted).size(), 0);
  EXPECT_EQ(fuse_views({}, FeatureFusion::kMaxCosine).size(), 0);
}

TEST(MergeAppearance, KeepsAllViewsAndDirections) {
  Appearances all;
  all[3].views = {view(1, 10), view(7, 30)};
  all[3].coverage.bins = BinSet(128);
  all[3].coverage.bins.set(5);
  all[3].coverage.largest_px = 30;
  all[3].queries = 2;
  all[9].views = {view(4, 50)};
  all[9].coverage.bins = BinSet(128);
  all[9].coverage.bins.set(100);
  all[9].coverage.largest_px = 50;
  all[9].queries = 3;
  merge_appearance(all, 3, 9);
  ASSERT_EQ(all.size(), 1u);
  const Appearance& merged = all.at(3);
  ASSERT_EQ(merged.views.size(), 3u);
  EXPECT_EQ(merged.views[1].frame, 4);
  EXPECT_EQ(merged.queries, 5);
  EXPECT_EQ(merged.coverage.largest_px, 50);
  EXPECT_TRUE(merged.coverage.bins.has(5) && merged.coverage.bins.has(100));
}

TEST(MergeAppearance, IgnoresWhatItDoesNotKnow) {
  Appearances all;
  all[3].views = {view(1, 10)};
  merge_appearance(all, 3, 4);
  merge_appearance(all, 3, 3);
  EXPECT_EQ(all.at(3).views.size(), 1u);
  merge_appearance(all, 8, 3);  // the survivor was never seen well
  EXPECT_EQ(all.at(8).views.size(), 1u);
  EXPECT_FALSE(all.contains(3));
}

TEST(FollowMerges, MovesWhatWasKnownToTheSurvivor) {
  InstanceRegistry registry;
  InstanceRegistry::State state;
  state.records = {{2, {5, 0, 4}}};
  state.aliases = {{6, 2}};
  state.last_id = 6;
  registry.restore(state);
  Appearances all;
  all[6].views = {view(1, 10)};
  follow_merges(all, registry);
  EXPECT_EQ(all.at(2).views.size(), 1u);
  EXPECT_EQ(all.size(), 1u);
}

TEST(PruneCrops, KeepsTheLargest) {
  Appearance appearance;
  appearance.views = {with_crop(view(1, 10)), with_crop(view(2, 30)), view(3, 99),
                      with_crop(view(4, 20)), with_crop(view(5, 20))};
  prune_crops(appearance, 2);
  std::vector<std::int64_t> kept;
  for (const ObjectView& v : appearance.views)
    if (!v.crop.empty()) kept.push_back(v.frame);
  EXPECT_EQ(kept, (std::vector<std::int64_t>{2, 4}));
  prune_crops(appearance, 0);
  for (const ObjectView& v : appearance.views) EXPECT_TRUE(v.crop.empty());
}

TEST(FusedEmbeddings, AreZeroForUnknownObjects) {
  Appearances all;
  all[5].views = {view(1, 10, {0, 1})};
  const std::vector<InstanceId> ids = {4, 5};
  const Embeddings rows = fused_embeddings(all, ids, FeatureFusion::kPixelWeighted, 2);
  EXPECT_EQ(rows.row(0).norm(), 0.f);
  EXPECT_EQ(rows(1, 1), 1.f);
}

}  // namespace
}  // namespace ovimap
