// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/views/telling_pixels.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

constexpr int kSide = 120;

/// Checks of 20 pixels whose upright edges are smeared over so many pixels.
RgbImage checks(int smear_px) {
  RgbImage image(kSide, kSide);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      int bright = 0;
      for (int i = 0; i < smear_px; ++i) bright += (x + i) / 20 % 2 == y / 20 % 2;
      const auto level = static_cast<std::uint8_t>(60 + 120 * bright / smear_px);
      image.at(x, y) = {level, level, level};
    }
  return image;
}

Frame frame_of(RgbImage color) {
  Frame frame;
  frame.color = std::move(color);
  frame.color_camera = frame.depth_camera = {kSide, kSide, 100, 100, 59.5f, 59.5f};
  return frame;
}

ObjectCrop crop_of(RgbImage image) {
  const int width = image.width(), height = image.height();
  return {std::move(image),
          Image<std::uint8_t>(width, height, 1),
          {Eigen::Vector2i(0, 0), Eigen::Vector2i(width - 1, height - 1)}};
}

int count(const Frame& frame, const RgbImage& crop) {
  return TellingPixels(frame, {}).count(8000, crop_of(crop));
}

TEST(TellingPixels, AreFewerBySoManyPixelsAsOneIsSmearedOver) {
  EXPECT_EQ(count(frame_of(checks(1)), checks(1)), 8000);
  EXPECT_EQ(count(frame_of(checks(2)), checks(2)), 8000) << "no camera is sharper";
  EXPECT_NEAR(count(frame_of(checks(4)), checks(4)), 4000, 100);
  EXPECT_NEAR(count(frame_of(checks(8)), checks(8)), 2000, 100);
  const Frame frame = frame_of(checks(8));
  EXPECT_EQ(TellingPixels(frame, {.sharp_edge_px = 0.f}).count(8000, crop_of(checks(8))), 8000);
}

TEST(TellingPixels, OfACropWithoutEdgesAreThoseOfTheFrame) {
  const RgbImage plain(40, 40, {90, 90, 90});
  EXPECT_EQ(count(frame_of(checks(1)), plain), 8000);
  EXPECT_NEAR(count(frame_of(checks(8)), plain), 2000, 100);
  EXPECT_EQ(count(frame_of(RgbImage(kSide, kSide, {90, 90, 90})), plain), 8000);
}

TEST(TellingPixels, CountsPixelsOfDepthWhereColourIsFiner) {
  Frame frame = frame_of(checks(8));
  frame.depth_camera = {kSide / 4, kSide / 4, 25, 25, 14.5f, 14.5f};
  EXPECT_EQ(count(frame, checks(8)), 8000) << "two pixels of depth";
}

TEST(TellingPixels, AreNoneWhereAllIsBurntOutOrBlack) {
  ObjectCrop crop = crop_of(checks(1));
  EXPECT_EQ(clipped_share(crop), 0.f);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < 30; ++x) {
      crop.image.at(x, y) = {255, 254, 255};
      crop.image.at(x + 30, y) = {0, 0, 2};
      crop.image.at(x + 60, y) = {255, 0, 0};  // red is a colour
    }
  EXPECT_EQ(clipped_share(crop), 0.5f);
  const Frame frame = frame_of(checks(1));
  EXPECT_EQ(TellingPixels(frame, {}).count(8000, crop), 4000);
  crop.image.fill({255, 255, 255});
  EXPECT_EQ(TellingPixels(frame, {}).count(8000, crop), 1);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) crop.mask.at(x, y) = x >= 60;
  crop.image = checks(1);
  crop.image.at(0, 0) = {0, 0, 0};
  EXPECT_EQ(clipped_share(crop), 0.f) << "beside the object";
}

TEST(TellingPixels, WeighsViewsAndWaitsForBetterOnes) {
  const auto weighed = [](int smear_px, bool first, ObjectView& view) {
    view.visible_px = 8000;
    view.directions.bins = BinSet(64);
    const Frame frame = frame_of(checks(smear_px));
    return TellingPixels(frame, {}).weigh(view, crop_of(frame.color), first);
  };
  ObjectView view;
  EXPECT_TRUE(weighed(1, false, view));
  EXPECT_EQ(view.visible_px, 8000);
  EXPECT_TRUE(weighed(3, false, view));
  EXPECT_NEAR(view.visible_px, 5333, 100);
  EXPECT_FALSE(view.directions.bins.empty());
  EXPECT_FALSE(weighed(8, false, view));
  EXPECT_TRUE(weighed(8, true, view));
  EXPECT_NEAR(view.visible_px, 2000, 100);
  EXPECT_TRUE(view.directions.bins.empty()) << "covers nothing";
}

}  // namespace
}  // namespace ovimap
