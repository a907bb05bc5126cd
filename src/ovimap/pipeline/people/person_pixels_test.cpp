// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/people/person_pixels.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

constexpr int kWidth = 60, kHeight = 80;

void fill_box(DepthImage& depth, int left, int top, int right, int bottom, float metres) {
  for (int v = top; v < bottom; ++v)
    for (int u = left; u < right; ++u) depth.at(u, v) = metres;
}

/// Somebody 2 m away, at columns 20 to 39 and rows 10 to 69, before a wall 3 m away.
Frame somebody() {
  Frame frame;
  frame.depth_camera = frame.color_camera = {kWidth, kHeight, 70.f, 70.f, 29.5f, 39.5f};
  frame.color = RgbImage(kWidth, kHeight, {9, 9, 9});
  frame.depth = DepthImage(kWidth, kHeight, 3.f);
  fill_box(frame.depth, 20, 10, 40, 70, 2.f);
  return frame;
}

const Eigen::AlignedBox2f kPersonBox(Eigen::Vector2f(15, 5), Eigen::Vector2f(45, 75));

TEST(PixelsByDepth, AreTheBodyAndWhatHasNoDepth) {
  Frame frame = somebody();
  fill_box(frame.depth, 25, 10, 32, 16, 0.f);  // hair gives none
  fill_box(frame.depth, 44, 5, 46, 20, 0.f);   // nor does something beside, half of it in the box
  const PeopleMask mask = pixels_by_depth(frame, color_places(frame), kPersonBox, {});
  EXPECT_EQ(mask.at(30, 40), 1);
  EXPECT_EQ(mask.at(20, 69), 1);
  EXPECT_EQ(mask.at(28, 12), 1) << "hair";
  EXPECT_EQ(mask.at(44, 10), 1) << "who knows what that is";
  EXPECT_EQ(mask.at(46, 10), 0) << "outside the box";
  EXPECT_EQ(mask.at(18, 40), 0) << "the wall beside";
  EXPECT_EQ(mask.at(5, 40), 0);
}

TEST(PixelsByDepth, ABodyGoesOnOverSmallStepsAndEndsAtLargeOnes) {
  Frame frame = somebody();
  for (int v = 55; v < 70; ++v)  // knees of somebody who sits
    for (int u = 20; u < 40; ++u) frame.depth.at(u, v) = 2.f - 0.03f * static_cast<float>(v - 54);
  fill_box(frame.depth, 40, 20, 44, 60, 2.3f);  // a cupboard beside, 30 cm behind
  const PeopleMask mask = pixels_by_depth(frame, color_places(frame), kPersonBox, {});
  EXPECT_EQ(mask.at(30, 69), 1) << "knees";
  EXPECT_EQ(mask.at(42, 40), 0) << "cupboard";
}

TEST(PixelsByDepth, WithoutAnyDepthItIsTheBox) {
  Frame frame = somebody();
  frame.depth.fill(0.f);
  const PeopleMask mask = pixels_by_depth(frame, color_places(frame), kPersonBox, {});
  EXPECT_EQ(mask.at(15, 5), 1);
  EXPECT_EQ(mask.at(45, 75), 1);
  EXPECT_EQ(mask.at(46, 75), 0);
}

TEST(ColorPlaces, AreWhereTheOtherCameraSeesAPoint) {
  Frame frame = somebody();
  frame.color_from_depth.translation().x() = 0.2;  // 7 px at 2 m
  const auto places = color_places(frame);
  EXPECT_EQ(places.at(30, 40), 40 * kWidth + 37);
  EXPECT_EQ(places.at(59, 40), -1) << "outside";
  frame.depth.at(30, 40) = 0;
  EXPECT_EQ(color_places(frame).at(30, 40), -1);
}

TEST(Grown, ReachesSoFarInASquare) {
  PeopleMask mask(11, 9);
  mask.at(5, 4) = 1;
  const PeopleMask wide = grown(mask, 2);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 11; ++x)
      EXPECT_EQ(wide.at(x, y), std::abs(x - 5) <= 2 && std::abs(y - 4) <= 2) << x << " " << y;
  EXPECT_EQ(grown(mask, 0), mask);
  EXPECT_EQ(extent_of(wide).min(), Eigen::Vector2f(3, 2));
  EXPECT_TRUE(extent_of(PeopleMask(4, 4)).isEmpty());
}

}  // namespace
}  // namespace ovimap
