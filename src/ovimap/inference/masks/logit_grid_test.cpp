// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/masks/logit_grid.h"

#include <gtest/gtest.h>

#include "ovimap/inference/masks/bit_mask.h"

namespace ovimap {
namespace {

/// 64 x 48 pixels on the upper part of a 16 x 16 grid over a 64 x 64 input.
LogitGrid example_grid() {
  ImageInputSpec spec;
  spec.size_px = 64;
  return logit_grid(input_frame(64, 48, spec), 64, 16, 64, 48);
}

TEST(LogitGrid, KnowsThePartTheImageFills) {
  const LogitGrid grid = example_grid();
  EXPECT_EQ(grid.width, 16);
  EXPECT_EQ(grid.height, 12);
  EXPECT_FLOAT_EQ(grid.image_px_per_grid_px(), 16.f);
  // The first grid pixel covers image pixels 0..3, whose middle is 1.5.
  EXPECT_TRUE(grid.to_image({0, 0}).isApprox(Eigen::Vector2f(1.5f, 1.5f)));
  EXPECT_TRUE(grid.from_image({5.5f, 1.5f}).isApprox(Eigen::Vector2f(1, 0)));
}

// Bilinear interpolation is exact on a linear ramp.
TEST(LogitRow, FollowsARamp) {
  const LogitGrid grid = example_grid();
  std::vector<float> logits(16 * 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      logits[static_cast<std::size_t>(y * 16 + x)] =
          2.f * static_cast<float>(x) - 3.f * static_cast<float>(y);
  for (int y = 2; y < 46; ++y) {
    const LogitRow row(logits, grid, y);
    for (int x = 2; x < 62; ++x) {
      const Eigen::Vector2f at = grid.from_image({static_cast<float>(x), static_cast<float>(y)});
      EXPECT_NEAR(row.at(x), 2 * at.x() - 3 * at.y(), 1e-4);
    }
  }
}

TEST(LogitRow, ClampsAtTheImagesEdge) {
  const LogitGrid grid = example_grid();
  std::vector<float> logits(16 * 16, 1.f);
  for (std::size_t i = 12 * 16; i < logits.size(); ++i) logits[i] = -100.f;  // padding rows
  for (const int y : {0, 46, 47}) {
    const LogitRow row(logits, grid, y);
    for (const int x : {0, 31, 63}) EXPECT_FLOAT_EQ(row.at(x), 1.f);
  }
}

TEST(BitMask, CountsAndOverlaps) {
  BitMask a(10, 9), b(10, 9);
  for (int x = 0; x < 10; ++x) a.set(x, 8);
  for (int y = 0; y < 9; ++y) b.set(3, y);
  EXPECT_EQ(a.count(), 10);
  EXPECT_EQ(a.overlap(b), 1);
  a.clear(3, 8);
  EXPECT_FALSE(a.at(3, 8));
  EXPECT_EQ(a.overlap(b), 0);
  a |= b;
  EXPECT_EQ(a.count(), 18);
  EXPECT_TRUE(a.at(3, 0));
}

}  // namespace
}  // namespace ovimap
