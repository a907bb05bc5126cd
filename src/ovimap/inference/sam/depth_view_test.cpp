// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/depth_view.h"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "ovimap/inference/models/test_support.h"

namespace ovimap {
namespace {

constexpr int kGridRows = 12, kGridColumns = 16;

/// A wall whose depth grows to the right by the factor exp(slope_px) from pixel to pixel.
Frame slanted(float slope_px) {
  Frame frame;
  frame.color_camera = frame.depth_camera = {64, 48, 60, 60, 31.5f, 23.5f};
  frame.color = RgbImage(64, 48);
  frame.depth = DepthImage(64, 48);
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u)
      frame.depth.at(u, v) = 2 * std::exp(slope_px * (static_cast<float>(u) - 31.5f));
  return frame;
}

float value(const FloatTensor& view, int map, int x, int y) {
  return view.values[static_cast<std::size_t>((map * kGridRows + y) * kGridColumns + x)];
}

TEST(DepthView, SaysSizeAndSlopeOfAPixel) {
  // Of 4 x 4 image pixels each: a focal length of 15 of the grid's.
  const FloatTensor view = depth_view(slanted(0.01f), {0.25f, 0.25f}, kGridRows, kGridColumns);
  EXPECT_EQ(view.shape, (TensorShape{1, kDepthMaps, kGridRows, kGridColumns}));
  EXPECT_NEAR(value(view, 0, 7, 5), std::log(2 * std::exp(-0.02f) / 15) + 5, 1e-3);
  EXPECT_NEAR(value(view, 1, 7, 5), 0.5f * 15 * 0.04f, 1e-3);  // back to the right
  EXPECT_NEAR(value(view, 2, 7, 5), 0, 1e-3);
  EXPECT_EQ(value(view, 3, 7, 5), 1);
  EXPECT_NEAR(value(view, 1, 0, 5), 0.5f * 15 * 0.04f, 1e-3);  // one neighbour is enough
}

TEST(DepthView, IsZeroWhereNoDepthIsKnownAndBoundedAtSteps) {
  Frame frame = slanted(0);
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u) frame.depth.at(u, v) = u < 16 ? 0 : u < 32 ? 1 : 9;
  const FloatTensor view = depth_view(frame, {0.25f, 0.25f}, kGridRows, kGridColumns);
  for (int map = 0; map < kDepthMaps; ++map) EXPECT_EQ(value(view, map, 2, 5), 0);
  EXPECT_EQ(value(view, 1, 7, 5), 2);
}

TEST(DepthView, LeavesNoGapsBetweenTheColumnsOfACoarseSensor) {
  Frame frame = slanted(0);
  frame.depth_camera = {8, 6, 7.5f, 7.5f, 3.5f, 2.5f};
  frame.depth = DepthImage(8, 6, 2.f);
  const FloatTensor view = depth_view(frame, {0.25f, 0.25f}, kGridRows, kGridColumns);
  for (int y = 1; y + 1 < kGridRows; ++y)
    for (int x = 1; x + 1 < kGridColumns; ++x) EXPECT_EQ(value(view, 3, x, y), 1) << x << ' ' << y;
}

/// tests/depth_geometry_test.py holds what the finder learns from against the same file.
TEST(DepthView, ShowsTheFinderWhatItWasTrainedWith) {
  std::ifstream file(inference_testdata() / "golden_depth_view.txt");
  int rows = 0, columns = 0;
  float focal_px = 0;
  ASSERT_TRUE(file >> rows >> columns >> focal_px);
  Frame frame;
  frame.color_camera = frame.depth_camera = {columns,
                                             rows,
                                             focal_px,
                                             focal_px,
                                             0.5f * static_cast<float>(columns - 1),
                                             0.5f * static_cast<float>(rows - 1)};
  frame.color = RgbImage(columns, rows);
  frame.depth = DepthImage(columns, rows);
  for (float& depth : frame.depth) {
    float inverse = 0;
    ASSERT_TRUE(file >> inverse);
    depth = inverse > 0 ? 1 / inverse : 0;
  }
  const FloatTensor view = depth_view(frame, {1, 1}, rows, columns);
  ASSERT_EQ(view.values.size(), static_cast<std::size_t>(kDepthMaps * rows * columns));
  for (std::size_t i = 0; i < view.values.size(); ++i) {
    float expected = 0;
    ASSERT_TRUE(file >> expected);
    EXPECT_NEAR(view.values[i], expected, 1e-4) << i;
  }
}

TEST(DepthView, OfAFrameWithoutDepthSaysNothing) {
  const FloatTensor view = depth_view({}, {1, 1}, 2, 3);
  EXPECT_EQ(view.values, std::vector<float>(kDepthMaps * 6, 0.f));
}

}  // namespace
}  // namespace ovimap
