// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/views/appearance.h"

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

std::vector<const ObjectView*> refs(const std::vector<ObjectView>& views) {
  std::vector<const ObjectView*> result;
  for (const ObjectView& view : views) result.push_back(&view);
  return result;
}

ObjectView with_crop(ObjectView view) {
  view.crop.image_jpeg = {1, 2, 3};
  return view;
}

TEST(ThingsOf, ManyViewsSayNoMoreThanTwiceWhatOneDoes) {
  std::vector<ObjectView> views(20);
  EXPECT_EQ(things_of(refs(views)).size(), 0) << "nothing looked at them";
  views[0].things = Eigen::Vector2f(3, -1);
  const Eigen::VectorXf one = things_of(refs(views));
  ASSERT_EQ(one.size(), 2);
  EXPECT_NEAR(one[0], 3.f, 0.2f);
  for (ObjectView& view : views) view.things = views[0].things;
  const Eigen::VectorXf all = things_of(refs(views));
  EXPECT_GT(all[0], 1.5f * one[0]);
  EXPECT_LT(all[0], 2.f * one[0]);
}

TEST(ThingsOf, OneMissCostsLittle) {
  std::vector<ObjectView> views(2);
  views[0].things = Eigen::VectorXf::Constant(1, 5.f);
  views[1].things = Eigen::VectorXf::Constant(1, -50.f);
  EXPECT_GT(things_of(refs(views))[0], 1.f);
}

TEST(FuseViews, WeighsByPixels) {
  const std::vector<ObjectView> views = {view(1, 300, {1, 0}), view(2, 100, {0, 1})};
  const Eigen::VectorXf fused = fuse_views(refs(views), FeatureFusion::kPixelWeighted);
  EXPECT_NEAR(fused.norm(), 1, 1e-6);
  EXPECT_NEAR(fused[0] / fused[1], 3, 1e-5);
  const Eigen::VectorXf mean = fuse_views(refs(views), FeatureFusion::kMean);
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
  EXPECT_TRUE(
      fuse_views(refs(views), FeatureFusion::kMaxCosine).isApprox(views[2].embedding, 1e-5f));
  EXPECT_TRUE(fuse_views(refs(views), FeatureFusion::kMinL1).isApprox(views[1].embedding, 1e-5f));
}

TEST(FuseViews, MayTakeTheLargestAlone) {
  std::vector<ObjectView> views = {view(1, 5, {0, 1}), view(2, 9, {1, 0}), view(3, 7, {1, 0}),
                                   view(4, 5, {0, 1})};
  const auto east = Eigen::Vector2f(1, 0);
  EXPECT_TRUE(fuse_views(refs(views), {FeatureFusion::kPixelWeighted, 2}).isApprox(east));
  EXPECT_TRUE(fuse_views(refs(views), {FeatureFusion::kMean, 2}).isApprox(east));
  EXPECT_GT(fuse_views(refs(views), {FeatureFusion::kMean, 3})[1], 0.1f);
  EXPECT_EQ(fuse_views(refs(views), {FeatureFusion::kMean, 4}),
            fuse_views(refs(views), FeatureFusion::kMean));
  EXPECT_EQ(fuse_views(refs(views), {FeatureFusion::kMean, 0}),
            fuse_views(refs(views), FeatureFusion::kMean));
  views[1].embedding = {};  // not answered: the next in size takes its place
  EXPECT_GT(fuse_views(refs(views), {FeatureFusion::kMean, 2})[1], 0.1f);
}

TEST(FuseViews, PassesOverViewsWithoutAnswer) {
  std::vector<ObjectView> views = {view(1, 100, {0, 1}), view(2, 1000)};
  views[1].embedding = {};
  EXPECT_TRUE(
      fuse_views(refs(views), FeatureFusion::kPixelWeighted).isApprox(Eigen::Vector2f(0, 1)));
  views[0].embedding = {};
  EXPECT_EQ(fuse_views(refs(views), FeatureFusion::kPixelWeighted).size(), 0);
  EXPECT_EQ(fuse_views({}, FeatureFusion::kMaxCosine).size(), 0);
}

SuperPointLook look(Label label, const std::vector<std::int64_t>& frames) {
  SuperPointLook result;
  for (const std::int64_t frame : frames) {
    result.views.push_back(view(frame, 10));
    result.views.back().super_point = label;
  }
  result.queries = static_cast<int>(frames.size());
  result.offered = 2 * result.queries;
  result.seen_in_world.extend(Eigen::Vector3f::Constant(static_cast<float>(label)));
  return result;
}

std::vector<std::int64_t> frames_of(const std::vector<const ObjectView*>& views) {
  std::vector<std::int64_t> frames;
  for (const ObjectView* view : views) frames.push_back(view->frame);
  return frames;
}

TEST(AppearanceOf, IsWhatItsSuperPointsLookLikeTogether) {
  const SuperPointLooks looks = {{3, look(3, {1, 7})}, {9, look(9, {4})}, {12, look(12, {2})}};
  const Appearance whole = appearance_of(looks, std::vector<Label>{3, 9, 11});
  EXPECT_EQ(frames_of(whole.views), (std::vector<std::int64_t>{1, 4, 7}));
  EXPECT_EQ(whole.queries, 3);
  EXPECT_EQ(whole.offered, 6);
  EXPECT_TRUE(whole.seen_in_world.contains(Eigen::Vector3f::Constant(6)));
  const Appearance part = appearance_of(looks, std::vector<Label>{9});
  EXPECT_EQ(frames_of(part.views), (std::vector<std::int64_t>{4}));
  EXPECT_EQ(part.queries, 1);
  EXPECT_TRUE(appearance_of(looks, std::vector<Label>{11}).views.empty());
}

TEST(FollowMerges, PutsMergedSuperPointsTogetherForGood) {
  LabelForest forest;
  for (int i = 0; i < 9; ++i) forest.create();
  SuperPointLooks looks = {{3, look(3, {1, 7})}, {8, look(8, {4})}, {9, look(9, {4, 5})}};
  forest.merge(3, 9);
  follow_merges(looks, forest);
  ASSERT_EQ(looks.size(), 2u);
  EXPECT_EQ(looks.at(3).views.size(), 4u);
  EXPECT_EQ(looks.at(3).queries, 4);
  EXPECT_EQ(looks.at(3).views[1].super_point, 9u) << "a view's key stays";
  EXPECT_NE(find_view(looks.at(3), {5, 9}), nullptr);
  EXPECT_EQ(find_view(looks.at(3), {5, 3}), nullptr);
}

TEST(PruneCrops, KeepsTheLargest) {
  SuperPointLook appearance;
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
  SuperPointLooks looks;
  looks[5].views = {view(1, 10, {0, 1})};
  std::vector<InstanceSummary> objects(2);
  objects[0].super_points = {4};
  objects[1].super_points = {5};
  const Embeddings rows = fused_embeddings(looks, objects, FeatureFusion::kPixelWeighted, 2);
  EXPECT_EQ(rows.row(0).norm(), 0.f);
  EXPECT_EQ(rows(1, 1), 1.f);
}

}  // namespace
}  // namespace ovimap
