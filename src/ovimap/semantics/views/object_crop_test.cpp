// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/views/object_crop.h"

#include <optional>

#include <gtest/gtest.h>

#include "ovimap/frames/frame/registration.h"

namespace ovimap {
namespace {

/// A red square (instance 7) on green ground, one metre away; colour and depth share a camera.
class CutObject : public ::testing::Test {
 protected:
  static constexpr int kWidth = 80, kHeight = 60;

  CutObject() : depth_(kWidth, kHeight, 1.f), instances_(kWidth, kHeight) {
    frame_.color = RgbImage(kWidth, kHeight, {0, 200, 0});
    frame_.color_camera = frame_.depth_camera = {kWidth, kHeight, 100, 100, 39.5f, 29.5f};
    frame_.depth = depth_;
    for (int y = 20; y < 40; ++y)
      for (int x = 30; x < 50; ++x) {
        frame_.color.at(x, y) = {200, 0, 0};
        instances_.at(x, y) = 7;
      }
  }

  /// As the colour camera sees it now.
  ObjectPixels square() {
    registration_.emplace(frame_, depth_, 0.05f);
    return {registration_->color_index(),
            instances_,
            7,
            {Eigen::Vector2i(30, 20), Eigen::Vector2i(49, 39)}};
  }

  Frame frame_;
  DepthImage depth_;
  Image<InstanceId> instances_;
  std::optional<Registration> registration_;
};

TEST_F(CutObject, TakesTheObjectWithItsSurroundings) {
  const auto crop = cut_object(frame_, square(), {});
  ASSERT_TRUE(crop);
  EXPECT_EQ(crop->image.width(), 28);  // 20 px and 0.2 of it on each side
  EXPECT_EQ(crop->image.height(), 28);
  EXPECT_EQ(crop->object_px.min(), Eigen::Vector2i(4, 4));
  EXPECT_EQ(crop->object_px.max(), Eigen::Vector2i(23, 23));
  for (int y = 0; y < 28; ++y)
    for (int x = 0; x < 28; ++x)
      ASSERT_EQ(crop->mask.at(x, y) != 0, crop->image.at(x, y) == (Rgb8{200, 0, 0}));
}

TEST_F(CutObject, StaysInsideTheImage) {
  instances_.fill(7);
  ObjectPixels everything = square();
  everything.box_px = {Eigen::Vector2i(0, 0), Eigen::Vector2i(79, 59)};
  const auto crop = cut_object(frame_, everything, {});
  ASSERT_TRUE(crop);
  EXPECT_EQ(crop->image, frame_.color);
}

TEST_F(CutObject, FollowsTheColourCamera) {
  // The colour camera has twice the resolution and stands 0.1 m to the right of the depth camera:
  // what is 1 m away appears 20 colour pixels further left.
  frame_.color_camera = {2 * kWidth, 2 * kHeight, 200, 200, 79.5f, 59.5f};
  frame_.color_from_depth.translation() = Eigen::Vector3d(-0.1, 0, 0);
  frame_.color = RgbImage(2 * kWidth, 2 * kHeight, {0, 200, 0});
  for (int y = 40; y < 80; ++y)
    for (int x = 40; x < 80; ++x) frame_.color.at(x, y) = {200, 0, 0};
  const auto crop = cut_object(frame_, square(), {});
  ASSERT_TRUE(crop);
  int inside = 0, wrong = 0;
  for (std::size_t i = 0; i < crop->mask.size(); ++i) {
    const bool red = crop->image[i] == Rgb8{200, 0, 0};
    inside += red;
    wrong += red != (crop->mask[i] != 0);
  }
  EXPECT_GT(inside, 1400);
  EXPECT_LT(wrong, 200);  // a rim of a pixel
}

TEST_F(CutObject, FindsNothingOutsideTheColourImage) {
  frame_.color_from_depth.translation() = Eigen::Vector3d(-5, 0, 0);
  EXPECT_FALSE(cut_object(frame_, square(), {}));
}

TEST_F(CutObject, GivesEveryScaleWithAndWithoutBackground) {
  CropConfig config;
  const auto variants = crop_variants(*cut_object(frame_, square(), config), config);
  ASSERT_EQ(variants.size(), 6u);
  EXPECT_EQ(variants[0].width(), 20);
  EXPECT_EQ(variants[2].width(), 24);
  EXPECT_EQ(variants[4].width(), 28);
  EXPECT_EQ(variants[4].at(0, 0), (Rgb8{0, 200, 0}));
  EXPECT_EQ(variants[5].at(0, 0), (Rgb8{128, 128, 128}));
  EXPECT_EQ(variants[5].at(14, 14), (Rgb8{200, 0, 0}));
  config.masked = false;
  config.scales = 1;
  EXPECT_EQ(crop_variants(*cut_object(frame_, square(), config), config).size(), 1u);
}

TEST_F(CutObject, ComesBackFromTheMapSmaller) {
  CropConfig config;
  config.kept_size_px = 14;
  const ObjectCrop crop = *cut_object(frame_, square(), config);
  const ObjectCrop back = restore_crop(store_crop(crop, config));
  EXPECT_EQ(back.image.width(), 14);
  EXPECT_EQ(back.object_px.min(), Eigen::Vector2i(2, 2));
  EXPECT_EQ(back.object_px.max(), Eigen::Vector2i(11, 11));
  EXPECT_EQ(back.mask.at(7, 7), 1);
  EXPECT_EQ(back.mask.at(0, 0), 0);
  EXPECT_GT(back.image.at(7, 7).r, 150);
  config.kept_size_px = 224;  // never enlarged
  EXPECT_EQ(restore_crop(store_crop(crop, config)).image.width(), 28);
}

TEST_F(CutObject, RefusesStoredCropsThatDoNotFit) {
  StoredCrop stored = store_crop(*cut_object(frame_, square(), {}), {});
  stored.object_px.max().x() = 100;
  EXPECT_THROW(restore_crop(stored), Error);
  stored.image_jpeg.resize(20);
  EXPECT_THROW(restore_crop(stored), Error);
}

}  // namespace
}  // namespace ovimap
