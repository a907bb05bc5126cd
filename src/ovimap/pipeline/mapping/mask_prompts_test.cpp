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
