// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/mask_pool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace ovimap {
namespace {

constexpr int kPoolGrid = 32;
constexpr float kSure = 8.f;

struct Box {
  int x0, y0, x1, y1;
};

/// A 64 x 64 image on a 32 x 32 grid: two image pixels a grid pixel.
LogitGrid pool_grid() {
  ImageInputSpec spec;
  spec.size_px = 128;
  return logit_grid(input_frame(64, 64, spec), 128, kPoolGrid, 64, 64);
}

SamConfig test_config() {
  SamConfig config;
  config.min_mask_px = 16;
  return config;
}

/// Proposals of one mask each: +-kSure inside and outside a box of grid pixels. The first `unsure`
/// columns have logit 0.5, so they are inside but not at a raised threshold.
struct Proposal {
  Box box;
  float iou = 0.9f;
  int unsure = 0;
};

MaskProposals proposals_of(const std::vector<Proposal>& list) {
  MaskProposals proposals{static_cast<int>(list.size()), kPoolGrid, {}, {}};
  for (const Proposal& proposal : list) {
    const Box& box = proposal.box;
    for (int y = 0; y < kPoolGrid; ++y)
      for (int x = 0; x < kPoolGrid; ++x) {
        const bool inside = x >= box.x0 && x < box.x1 && y >= box.y0 && y < box.y1;
        const bool sure = x >= box.x0 + proposal.unsure;
        proposals.logits.push_back(inside ? (sure ? kSure : 0.5f) : -kSure);
      }
    proposals.predicted_iou.push_back(proposal.iou);
  }
  return proposals;
}

/// The region that fills `box` of grid pixels.
MaskPrompt region_of(const Box& box) {
  MaskPrompt region;
  region.extent_px = Eigen::AlignedBox2f(
      Eigen::Vector2f(2.f * static_cast<float>(box.x0), 2.f * static_cast<float>(box.y0)),
      Eigen::Vector2f(2.f * static_cast<float>(box.x1) - 1, 2.f * static_cast<float>(box.y1) - 1));
  region.interior_px = region.extent_px.center();
  region.area_px = 4 * (box.x1 - box.x0) * (box.y1 - box.y0);
  return region;
}

TEST(MaskPool, DropsWhatTheNetworkDoubts) {
  MaskPool pool(test_config(), pool_grid());
  EXPECT_FALSE(pool.offer(proposals_of({{{4, 4, 12, 12}, 0.8f}})));
  EXPECT_FALSE(pool.offer(proposals_of({{{4, 4, 12, 12}, 0.9f, 4}})));  // stability 0.5
  EXPECT_FALSE(pool.offer(proposals_of({{{4, 4, 5, 5}, 0.9f}})));       // 4 pixels of the image
  EXPECT_FALSE(pool.offer(proposals_of({{{0, 0, 32, 32}, 0.9f}})));     // all of the image
  EXPECT_TRUE(pool.masks().empty());
  EXPECT_EQ(pool.covered().count(), 0);
}

TEST(MaskPool, ScoreIsPredictedIouTimesStability) {
  MaskPool pool(test_config(), pool_grid());
  EXPECT_TRUE(pool.offer(proposals_of({{{4, 4, 14, 12}, 0.9f, 1}})));
  ASSERT_EQ(pool.masks().size(), 1u);
  EXPECT_EQ(pool.masks()[0].area, 80);
  EXPECT_FLOAT_EQ(pool.masks()[0].stability, 0.9f);
  EXPECT_FLOAT_EQ(pool.masks()[0].score, 0.81f);
  EXPECT_EQ(pool.covered().count(), 80);
}

TEST(MaskPool, WithoutRegionTakesTheLargestStable) {
  MaskPool pool(test_config(), pool_grid());
  pool.offer(
      proposals_of({{{8, 8, 12, 12}, 0.99f}, {{4, 4, 20, 20}, 0.85f}, {{2, 2, 26, 26}, 0.95f, 5}}));
  ASSERT_EQ(pool.masks().size(), 1u);
  EXPECT_EQ(pool.masks()[0].area, 16 * 16);  // the largest of all is too unstable to be preferred
}

TEST(MaskPool, WithRegionTakesTheOneOfItsSize) {
  MaskPool pool(test_config(), pool_grid());
  const MaskPrompt region = region_of({8, 8, 16, 16});
  EXPECT_TRUE(pool.offer(proposals_of({{{8, 8, 16, 16}, 0.9f}, {{0, 0, 30, 30}, 0.92f}}), &region));
  ASSERT_EQ(pool.masks().size(), 1u);
  EXPECT_EQ(pool.masks()[0].area, 64);
  EXPECT_TRUE(pool.masks()[0].own_region);
}

TEST(MaskPool, TellsWhenTheRegionIsNotExplained) {
  const MaskPrompt region = region_of({8, 8, 16, 16});
  MaskPool small(test_config(), pool_grid());
  EXPECT_FALSE(small.offer(proposals_of({{{8, 8, 12, 12}}}), &region));
  EXPECT_EQ(small.masks().size(), 1u);  // kept all the same
  MaskPool large(test_config(), pool_grid());
  EXPECT_FALSE(large.offer(proposals_of({{{0, 0, 24, 24}}}), &region));
  EXPECT_FALSE(large.masks()[0].own_region);
}

TEST(MaskPool, BoxPromptsAcceptOnlyMasksInTheBox) {
  MaskPool pool(test_config(), pool_grid());
  const MaskPrompt region = region_of({8, 8, 16, 16});
  EXPECT_FALSE(pool.offer(proposals_of({{{0, 0, 24, 24}, 0.95f}}), &region, true));
  EXPECT_TRUE(pool.masks().empty());
  EXPECT_TRUE(
      pool.offer(proposals_of({{{0, 0, 24, 24}, 0.95f}, {{8, 8, 16, 15}, 0.83f}}), &region, true));
  EXPECT_EQ(pool.masks()[0].area, 56);
}

TEST(MaskPool, KeepsTheBetterOfDuplicates) {
  MaskPool pool(test_config(), pool_grid());
  pool.offer(proposals_of({{{4, 4, 20, 20}, 0.85f}}));
  pool.offer(proposals_of({{{4, 4, 20, 19}, 0.95f}}));
  pool.offer(proposals_of({{{4, 4, 20, 18}, 0.90f}}));
  ASSERT_EQ(pool.masks().size(), 1u);
  EXPECT_EQ(pool.masks()[0].area, 16 * 15);
}

TEST(MaskPool, PaintsAtFullSizeSmallOverLarge) {
  MaskPool pool(test_config(), pool_grid());
  pool.offer(proposals_of({{{16, 16, 28, 28}}}));  // half of it lies on the next
  pool.offer(proposals_of({{{0, 0, 22, 32}, 0.95f}}));
  const Entities entities = pool.entities();
  ASSERT_EQ(entities.ids.width(), 64);
  ASSERT_EQ(entities.ids.height(), 64);
  ASSERT_EQ(entities.scores.size(), 2u);
  EXPECT_FLOAT_EQ(entities.scores[0], 0.95f);
  EXPECT_EQ(entities.ids.at(10, 10), 1);
  EXPECT_EQ(entities.ids.at(34, 40), 2);
  EXPECT_EQ(entities.ids.at(31, 40), 1);  // the boundary between grid columns 15 and 16
  EXPECT_EQ(entities.ids.at(32, 40), 2);
  EXPECT_EQ(entities.ids.at(60, 60), 0);
}

TEST(MaskPool, DropsParts) {
  MaskPool pool(test_config(), pool_grid());
  pool.offer(proposals_of({{{8, 8, 12, 12}, 0.93f}}));
  pool.offer(proposals_of({{{0, 0, 20, 20}, 0.90f}}));
  EXPECT_EQ(pool.entities().scores.size(), 1u);
  EXPECT_EQ(pool.entities().ids.at(20, 20), 1);
}

TEST(MaskPool, KeepsAMuchBetterMaskInAPoorOne) {
  MaskPool pool(test_config(), pool_grid());
  pool.offer(proposals_of({{{8, 8, 12, 12}, 0.99f}}));
  pool.offer(proposals_of({{{0, 0, 20, 20}, 0.83f}}));
  EXPECT_EQ(pool.entities().scores.size(), 2u);
}

// A mug on a table whose mask has no hole: geometry says that it is a thing of its own.
TEST(MaskPool, KeepsAThingOnItsSupport) {
  MaskPool pool(test_config(), pool_grid());
  const MaskPrompt mug = region_of({8, 8, 12, 12});
  pool.offer(proposals_of({{{0, 0, 28, 28}, 0.94f}}));
  pool.offer(proposals_of({{{8, 8, 12, 12}, 0.90f}}), &mug, true);
  const Entities entities = pool.entities();
  EXPECT_EQ(entities.scores.size(), 2u);
  EXPECT_EQ(entities.ids.at(20, 20), 2);
  EXPECT_EQ(entities.ids.at(40, 40), 1);
}

// A mask of the whole scene beneath those of a wall and a desk whose mask leaves out what lies on
// it: the pens and papers in its gaps are not one entity with each other and the floor's rim.
TEST(MaskPool, AMaskThatOthersHideIsNoEntityAndExplainsNothing) {
  SamConfig config = test_config();
  config.min_shown_share = 0.5f;
  MaskPool pool(config, pool_grid());
  const MaskPrompt wall = region_of({2, 2, 26, 12}), desk = region_of({2, 14, 26, 28});
  pool.offer(proposals_of({{{0, 0, 28, 30}, 0.90f}}));
  EXPECT_EQ(pool.covered().count(), 28 * 30);
  pool.offer(proposals_of({{{2, 2, 26, 12}, 0.90f}}), &wall);
  pool.offer(proposals_of({{{2, 14, 26, 28}, 0.90f}}), &desk);
  EXPECT_EQ(pool.masks().size(), 3u);
  const Entities entities = pool.entities();
  EXPECT_EQ(entities.scores.size(), 2u);
  EXPECT_EQ(entities.ids.at(20, 26), 0);  // between the two
  EXPECT_EQ(pool.covered().count(), 24 * 10 + 24 * 14);
}

TEST(MaskPool, PartsOfAHiddenMaskAreLookedAtWithoutIt) {
  SamConfig config = test_config();
  config.min_shown_share = 0.5f;
  MaskPool pool(config, pool_grid());
  const MaskPrompt wall = region_of({2, 2, 26, 12}), desk = region_of({2, 14, 26, 28});
  pool.offer(proposals_of({{{0, 0, 28, 30}, 0.90f}}));
  pool.offer(proposals_of({{{2, 2, 26, 12}, 0.90f}}), &wall);
  pool.offer(proposals_of({{{2, 14, 26, 28}, 0.90f}}), &desk);
  pool.offer(proposals_of({{{26, 14, 28, 28}, 0.90f}}));  // inside the scene alone
  EXPECT_EQ(pool.entities().scores.size(), 3u);
}

TEST(MaskPool, TakesAFindersOwnMaskThatIsLikeItsThing) {
  const MaskPrompt thing = region_of({2, 2, 12, 12}), other = region_of({2, 2, 30, 30});
  MaskPool pool(test_config(), pool_grid());
  EXPECT_FALSE(pool.offer_unasked(proposals_of({{{2, 2, 12, 12}, 0.5f}}), thing));  // not sure
  EXPECT_FALSE(pool.offer_unasked(proposals_of({{{2, 2, 12, 12}, 0.8f}}), other));  // a part
  EXPECT_FALSE(pool.offer_unasked(proposals_of({{{2, 2, 30, 12}, 0.8f}}), thing));  // reaches out
  EXPECT_TRUE(pool.offer_unasked(proposals_of({{{2, 2, 12, 12}, 0.8f}}), thing));
  EXPECT_EQ(pool.masks().size(), 1u);
}

/// A finder's cells of four image pixels, all of which see one box of grid pixels.
ThingCells cells_that_see(const Box& box) {
  constexpr int kSide = 16;
  constexpr float kCellPx = 4;
  FinderMaps maps;
  maps.rows = maps.columns = kSide;
  maps.image_from_cell = {kCellPx, kCellPx};
  maps.values.assign(FinderMaps::kMaps * kSide * kSide, kSure);
  const auto set = [&](int map, int x, int y, int grid_px) {
    maps.values[static_cast<std::size_t>((map * kSide + y) * kSide + x)] =
        std::log(std::max(0.01f, static_cast<float>(grid_px) / 2));
  };
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {  // two grid pixels a cell
      set(1, x, y, 2 * x + 1 - box.x0);
      set(2, x, y, 2 * y + 1 - box.y0);
      set(3, x, y, box.x1 - 2 * x - 1);
      set(4, x, y, box.y1 - 2 * y - 1);
    }
  return {maps, 64, 64};
}

TEST(MaskPool, AFinderTellsAPartFromAThing) {
  const Box small = {8, 8, 12, 12}, large = {0, 0, 20, 20};
  for (const bool is_thing : {true, false}) {
    MaskPool pool(test_config(), pool_grid(), cells_that_see(is_thing ? small : large));
    pool.offer(proposals_of({{small, 0.90f}}));
    pool.offer(proposals_of({{large, 0.90f}}));
    EXPECT_EQ(pool.entities().scores.size(), is_thing ? 2u : 1u);
  }
}

TEST(MaskPool, WhereAFinderHasNoCellScoresDecide) {
  const Box sliver = {8, 0, 9, 20}, large = {0, 0, 20, 20};  // no cell's middle lies in it
  MaskPool pool(test_config(), pool_grid(), cells_that_see(sliver));
  pool.offer(proposals_of({{sliver, 0.90f}}));
  pool.offer(proposals_of({{large, 0.90f}}));
  EXPECT_EQ(pool.entities().scores.size(), 1u);
}

TEST(MaskPool, OfTwoLikeMasksTheFindersIsKept) {
  const Box box{2, 2, 12, 12};
  const MaskPrompt thing = region_of(box);
  MaskPool pool(test_config(), pool_grid(), cells_that_see(box));
  pool.offer_unasked(proposals_of({{box, 0.8f}}), thing);
  pool.offer(proposals_of({{{2, 2, 12, 11}, 0.95f}}), &thing);
  ASSERT_EQ(pool.masks().size(), 1u);
  EXPECT_FLOAT_EQ(pool.masks()[0].score, 0.8f);
  EXPECT_EQ(pool.masks()[0].area, 100);
}

TEST(MaskPool, OfAKnownObjectOnlyALikeMaskIsTaken) {
  MaskPool pool(test_config(), pool_grid());
  MaskPrompt object = region_of({8, 8, 16, 16});
  object.known = true;
  EXPECT_FALSE(pool.offer(proposals_of({{{8, 8, 11, 16}, 0.95f}}), &object, true));
  EXPECT_TRUE(pool.masks().empty());
  EXPECT_TRUE(pool.offer(proposals_of({{{8, 8, 15, 16}, 0.95f}}), &object, true));
  EXPECT_EQ(pool.masks().size(), 1u);
}

}  // namespace
}  // namespace ovimap
