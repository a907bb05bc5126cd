// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/check/edge_alignment.h"

#include <gtest/gtest.h>

#include "ovimap/base/config.h"

namespace ovimap {
namespace {

/// Tiles that stand before a wall, in depth and, moved by some pixels, in colour.
Frame tiles(int width, int height, int shift_px) {
  Frame frame;
  frame.depth_camera = {width, height, 500, 500, width / 2.f, height / 2.f};
  frame.color_camera = frame.depth_camera;
  frame.depth = DepthImage(width, height);
  frame.color = RgbImage(width, height);
  const auto in_front = [](int x, int y) { return x / 60 % 2 == 0 && y / 60 % 2 == 0; };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      frame.depth.at(x, y) = in_front(x, y) ? 1.f : 2.f;
      frame.color.at(x, y) =
          in_front(x - shift_px + 240, y) ? Rgb8{200, 180, 90} : Rgb8{40, 60, 80};
    }
  return frame;
}

EdgeAlignment of(const Frame& frame) {
  EdgeAlignment alignment({});
  alignment.add(frame);
  alignment.add(frame);
  return alignment;
}

TEST(EdgeAlignment, ColourWhereDepthSaysIsRegistered) {
  const EdgeAlignment::Verdict verdict = of(tiles(640, 480, 0)).verdict();
  EXPECT_TRUE(verdict.registered);
  EXPECT_EQ(verdict.judged, 9);
  EXPECT_EQ(verdict.misplaced, 0);
}

TEST(EdgeAlignment, FindsTheShiftInEveryPartOfTheImage) {
  const EdgeAlignment alignment = of(tiles(640, 480, 16));
  for (const EdgeAlignment::Cell& cell : alignment.cells()) {
    EXPECT_EQ(cell.shift_px, Eigen::Vector2i(16, 0));
    EXPECT_GT(cell.gain, 1.2);
  }
  EXPECT_FALSE(alignment.verdict().registered);
  EXPECT_EQ(alignment.verdict().shift_px, 16);
}

TEST(EdgeAlignment, LooksColourUpThroughTheCameras) {
  Frame frame = tiles(640, 480, 16);
  frame.color_camera.cx += 16;  // the camera that saw it so
  EXPECT_TRUE(of(frame).verdict().registered);
}

TEST(EdgeAlignment, WithoutEdgesNothingIsJudged) {
  Frame frame = tiles(640, 480, 16);
  frame.depth.fill(2.f);
  EXPECT_EQ(of(frame).verdict().judged, 0);
  EXPECT_TRUE(of(frame).verdict().registered);
  EXPECT_EQ(of(tiles(60, 40, 16)).verdict().judged, 0);  // no room for shifts
}

TEST(EdgeAlignment, ListsItsFields) {
  EdgeAlignmentConfig config;
  ConfigFields fields;
  list_fields(config, fields);
  fields.set("min_misplaced_px", "12");
  EXPECT_EQ(config.min_misplaced_px, 12);
}

}  // namespace
}  // namespace ovimap
