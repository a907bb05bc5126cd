// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/prompt_planner.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ovimap {
namespace {

TEST(GridPrompts, LieInTheMiddleOfEqualCells) {
  const std::vector<PromptPoints> prompts = grid_prompts(640, 480, 2);
  ASSERT_EQ(prompts.size(), 4u);
  EXPECT_EQ(prompts[0].front().in_image_px, Eigen::Vector2f(159.5f, 119.5f));
  EXPECT_EQ(prompts[3].front().in_image_px, Eigen::Vector2f(479.5f, 359.5f));
  EXPECT_EQ(prompts[3].front().label, PointLabel::kForeground);
}

constexpr int kPlanGrid = 64;

/// A 256 x 256 image on a 64 x 64 grid: four image pixels a grid pixel.
LogitGrid plan_grid() {
  ImageInputSpec spec;
  spec.size_px = 256;
  return logit_grid(input_frame(256, 256, spec), 256, kPlanGrid, 256, 256);
}

MaskPrompt region_at(float x, float y, int area_px) {
  const float half_side = std::sqrt(static_cast<float>(area_px)) / 2;
  const Eigen::Vector2f centre(x, y), half(half_side, half_side);
  return {centre,
          Eigen::AlignedBox2f(Eigen::Vector2f(centre - half), Eigen::Vector2f(centre + half)),
          area_px};
}

/// Adds a mask over grid pixels x0..x1-1, y0..y1-1.
void cover(MaskPool& pool, int x0, int y0, int x1, int y1) {
  MaskProposals proposals{1, kPlanGrid, std::vector<float>(kPlanGrid * kPlanGrid, -8.f), {0.95f}};
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      proposals.logits[static_cast<std::size_t>(y * kPlanGrid + x)] = 8.f;
  ASSERT_TRUE(pool.offer(proposals));
}

/// One batch after another, until nothing is left or `limit` prompts were asked.
std::vector<PlannedPrompt> ask_all(PromptPlanner& planner, const MaskPool& pool, int limit) {
  std::vector<PlannedPrompt> asked;
  while (static_cast<int>(asked.size()) < limit) {
    const auto batch = planner.next(pool, 1);
    if (batch.empty()) break;
    asked.push_back(batch.front());
  }
  return asked;
}

TEST(PromptPlanner, AsksUncoveredRegionsLargestFirst) {
  const SamConfig config;
  const MaskPool pool(config, plan_grid());
  const std::vector<MaskPrompt> regions = {region_at(50, 50, 600), region_at(150, 60, 9000),
                                           region_at(60, 200, 5000), region_at(200, 200, 100)};
  PromptPlanner planner(config, plan_grid(), regions);
  std::vector<int> areas;
  for (const PlannedPrompt& prompt : ask_all(planner, pool, 100))
    if (const MaskPrompt* region = planner.region_of(prompt)) areas.push_back(region->area_px);
  EXPECT_EQ(areas, (std::vector<int>{9000, 5000, 600}));  // 100 is under min_region_px
}

TEST(PromptPlanner, AsksKnownObjectsFirstByTheirBoxes) {
  SamConfig config;
  config.min_hole_radius_px = 1000;  // regions alone
  const MaskPool pool(config, plan_grid());
  std::vector<MaskPrompt> regions = {region_at(150, 60, 9000), region_at(60, 200, 200),
                                     region_at(200, 200, 400), region_at(30, 30, 100)};
  for (std::size_t i = 1; i < 4; ++i) regions[i].known = true;
  PromptPlanner planner(config, plan_grid(), regions);
  const std::vector<PlannedPrompt> asked = ask_all(planner, pool, 3);
  ASSERT_EQ(asked.size(), 3u);
  EXPECT_EQ(planner.region_of(asked[0])->area_px, 400);
  EXPECT_EQ(planner.region_of(asked[1])->area_px, 200);  // under min_region_px, over min_mask_px
  EXPECT_EQ(planner.region_of(asked[2])->area_px, 9000);
  EXPECT_TRUE(asked[0].boxed && asked[1].boxed);
  EXPECT_FALSE(asked[2].boxed);
}

TEST(PromptPlanner, PointPromptsCarryAPaddingPoint) {
  SamConfig config;
  config.min_hole_radius_px = 1000;  // regions alone
  const MaskPool pool(config, plan_grid());
  const std::vector<MaskPrompt> regions = {region_at(50, 60, 9000)};
  PromptPlanner planner(config, plan_grid(), regions);
  const auto batch = planner.next(pool, 1);
  ASSERT_EQ(batch.size(), 1u);
  ASSERT_EQ(batch[0].points.size(), 2u);
  EXPECT_EQ(batch[0].points[0].label, PointLabel::kForeground);
  EXPECT_TRUE(batch[0].points[0].in_image_px.isApprox(Eigen::Vector2f(50, 60)));
  EXPECT_EQ(batch[0].points[1].label, PointLabel::kPadding);
}

TEST(PromptPlanner, SkipsAnExplainedRegion) {
  const SamConfig config;
  MaskPool pool(config, plan_grid());
  cover(pool, 0, 0, 64, 32);
  const std::vector<MaskPrompt> regions = {region_at(128, 60, 30000)};  // the mask is 32768 pixels
  PromptPlanner planner(config, plan_grid(), regions);
  for (const PlannedPrompt& prompt : ask_all(planner, pool, 100)) EXPECT_LT(prompt.region, 0);
}

TEST(PromptPlanner, AsksAThingOnASupportByItsBox) {
  SamConfig config;
  config.min_hole_radius_px = 1000;
  MaskPool pool(config, plan_grid());
  cover(pool, 0, 0, 64, 56);
  const std::vector<MaskPrompt> regions = {region_at(128, 60, 900)};
  PromptPlanner planner(config, plan_grid(), regions);
  const auto batch = planner.next(pool, 4);
  ASSERT_EQ(batch.size(), 1u);
  EXPECT_TRUE(batch[0].boxed);
  ASSERT_EQ(batch[0].points.size(), 3u);
  EXPECT_EQ(batch[0].points[1].label, PointLabel::kBoxMin);
  EXPECT_TRUE(batch[0].points[1].in_image_px.isApprox(Eigen::Vector2f(113, 45)));
  EXPECT_EQ(batch[0].points[2].label, PointLabel::kBoxMax);
  EXPECT_TRUE(batch[0].points[2].in_image_px.isApprox(Eigen::Vector2f(143, 75)));
  EXPECT_TRUE(planner.next(pool, 4).empty());
}

TEST(PromptPlanner, RetriesAFailedPointByTheBoxOnce) {
  SamConfig config;
  config.min_hole_radius_px = 1000;  // regions alone
  const MaskPool pool(config, plan_grid());
  const std::vector<MaskPrompt> regions = {region_at(50, 60, 9000)};
  PromptPlanner planner(config, plan_grid(), regions);
  const auto point = planner.next(pool, 4);
  ASSERT_EQ(point.size(), 1u);
  planner.failed(point[0]);
  const auto box = planner.next(pool, 4);
  ASSERT_EQ(box.size(), 1u);
  EXPECT_TRUE(box[0].boxed);
  planner.failed(box[0]);
  EXPECT_TRUE(planner.next(pool, 4).empty());
}

// Everything but a square is covered: its centre is asked, and not again when nothing came of it.
TEST(PromptPlanner, AsksTheMiddleOfAHole) {
  const SamConfig config;
  MaskPool pool(config, plan_grid());
  cover(pool, 0, 0, 64, 20);
  cover(pool, 0, 20, 30, 64);
  cover(pool, 41, 20, 64, 64);
  cover(pool, 30, 31, 41, 64);
  PromptPlanner planner(config, plan_grid(), {});
  const auto asked = ask_all(planner, pool, 100);
  ASSERT_GE(asked.size(), 1u);
  // Grid pixel (35, 25) covers image pixels 140..143 and 100..103.
  EXPECT_TRUE(asked[0].points[0].in_image_px.isApprox(Eigen::Vector2f(141.5f, 101.5f)));
  EXPECT_LE(asked.size(), 5u);  // then at most the corners around the disc
}

TEST(PromptPlanner, HolesOfABatchAreApart) {
  const SamConfig config;
  const MaskPool pool(config, plan_grid());
  PromptPlanner planner(config, plan_grid(), {});
  const auto batch = planner.next(pool, 4);
  ASSERT_EQ(batch.size(), 4u);
  for (std::size_t i = 0; i < batch.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT((batch[i].points[0].in_image_px - batch[j].points[0].in_image_px).norm(), 40.f);
}

TEST(PromptPlanner, ABatchHasOneNumberOfPoints) {
  const SamConfig config;
  MaskPool pool(config, plan_grid());
  cover(pool, 0, 0, 64, 32);
  const std::vector<MaskPrompt> regions = {region_at(60, 60, 4000), region_at(60, 200, 4000),
                                           region_at(180, 60, 2000), region_at(180, 200, 2000)};
  PromptPlanner planner(config, plan_grid(), regions);
  int boxed = 0;
  for (auto batch = planner.next(pool, 3); !batch.empty(); batch = planner.next(pool, 3))
    for (const PlannedPrompt& prompt : batch) {
      EXPECT_EQ(prompt.points.size(), batch.front().points.size());
      boxed += prompt.boxed;
    }
  EXPECT_EQ(boxed, 2);
}

TEST(PromptPlanner, IgnoresRegionsOutsideTheImage) {
  SamConfig config;
  config.min_hole_radius_px = 1000;
  const MaskPool pool(config, plan_grid());
  const std::vector<MaskPrompt> regions = {region_at(-20, 60, 4000), region_at(60, 256, 4000)};
  PromptPlanner planner(config, plan_grid(), regions);
  EXPECT_TRUE(planner.next(pool, 4).empty());
}

}  // namespace
}  // namespace ovimap
