// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/mask_prompts.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

/// A frame whose cameras are one, with depth everywhere.
Frame plain_frame() {
  Frame frame;
  frame.depth_camera = frame.color_camera = {80, 60, 70.f, 70.f, 39.5f, 29.5f};
  frame.color = RgbImage(80, 60);
  frame.depth = DepthImage(80, 60, 1.f);
  return frame;
}

Image<InstanceId> with_box(InstanceId id, int x0, int y0, int x1, int y1) {
  Image<InstanceId> instances(80, 60);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) instances.at(x, y) = id;
  return instances;
}

TEST(ObjectPrompts, AreTheBoxesOfTheObjectsInSight) {
  const Frame frame = plain_frame();
  Image<InstanceId> instances = with_box(700, 10, 20, 31, 41);
  instances.at(70, 50) = 9;
  const auto prompts = object_prompts(instances, Registration(frame), frame.color_camera);
  ASSERT_EQ(prompts.size(), 2u);
  EXPECT_EQ(prompts[0].area_px, 1);  // 9 comes before 700
  EXPECT_TRUE(prompts[1].known);
  EXPECT_EQ(prompts[1].area_px, 21 * 21);
  EXPECT_EQ(prompts[1].interior_px, Eigen::Vector2f(20, 30));
  EXPECT_EQ(prompts[1].extent_px.min(), Eigen::Vector2f(10, 20));
  EXPECT_EQ(prompts[1].extent_px.max(), Eigen::Vector2f(30, 40));
}

TEST(ObjectPrompts, AFewStrayPixelsDoNotWidenABox) {
  const Frame frame = plain_frame();
  Image<InstanceId> instances = with_box(3, 10, 20, 31, 41);
  instances.at(70, 50) = instances.at(71, 50) = 3;
  const auto prompts = object_prompts(instances, Registration(frame), frame.color_camera);
  ASSERT_EQ(prompts.size(), 1u);
  EXPECT_EQ(prompts[0].extent_px.max(), Eigen::Vector2f(30, 40));
}

TEST(RegionPrompts, CountEveryPixelAndAreNotKnown) {
  const Frame frame = plain_frame();
  DepthRegions regions{IdImage(80, 60), {{}}};
  for (int x = 10; x < 31; ++x) regions.ids.at(x, 20) = 1;
  regions.ids.at(70, 50) = 1;
  const auto prompts = region_prompts(regions, Registration(frame), frame.color_camera);
  ASSERT_EQ(prompts.size(), 1u);
  EXPECT_FALSE(prompts[0].known);
  EXPECT_EQ(prompts[0].area_px, 22);
  EXPECT_EQ(prompts[0].extent_px.max(), Eigen::Vector2f(70, 50));
}

}  // namespace
}  // namespace ovimap
