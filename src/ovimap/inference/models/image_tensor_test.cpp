// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/models/image_tensor.h"

#include <gtest/gtest.h>

#include "ovimap/image/resize.h"

namespace ovimap {
namespace {

ImageInputSpec spec_of(ResizeRule rule) {
  ImageInputSpec spec;
  spec.size_px = 64;
  spec.resize = rule;
  spec.mean = {10, 20, 30};
  spec.std = {2, 4, 5};
  return spec;
}

TEST(InputFrame, LongSideKeepsTheAspect) {
  const InputFrame wide = input_frame(640, 480, spec_of(ResizeRule::kLongSide));
  EXPECT_EQ(wide.width_px, 64);
  EXPECT_EQ(wide.height_px, 48);
  EXPECT_FLOAT_EQ(wide.scale.x(), 0.1f);
  EXPECT_FLOAT_EQ(wide.scale.y(), 0.1f);
  const InputFrame tall = input_frame(16, 32, spec_of(ResizeRule::kLongSide));
  EXPECT_EQ(tall.width_px, 32);
  EXPECT_EQ(tall.height_px, 64);
  EXPECT_FLOAT_EQ(tall.scale.x(), 2.f);
}

TEST(InputFrame, StretchFillsBothSides) {
  const InputFrame frame = input_frame(128, 32, spec_of(ResizeRule::kStretch));
  EXPECT_EQ(frame.width_px, 64);
  EXPECT_EQ(frame.height_px, 64);
  EXPECT_FLOAT_EQ(frame.scale.x(), 0.5f);
  EXPECT_FLOAT_EQ(frame.scale.y(), 2.f);
}

TEST(ImageTensor, NormalisesByChannelAndPadsWithZero) {
  RgbImage image(64, 32, Rgb8{12, 28, 25});
  image.at(63, 0) = {10, 20, 30};
  const FloatTensor tensor = image_tensor(image, spec_of(ResizeRule::kLongSide));
  ASSERT_EQ(tensor.shape, (TensorShape{1, 3, 64, 64}));
  const auto at = [&tensor](int channel, int y, int x) {
    return tensor.values[static_cast<std::size_t>((channel * 64 + y) * 64 + x)];
  };
  EXPECT_FLOAT_EQ(at(0, 0, 0), 1.f);   // (12 - 10) / 2
  EXPECT_FLOAT_EQ(at(1, 31, 5), 2.f);  // (28 - 20) / 4
  EXPECT_FLOAT_EQ(at(2, 7, 9), -1.f);  // (25 - 30) / 5
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(at(channel, 0, 63), 0.f, 1e-6);
    EXPECT_EQ(at(channel, 32, 0), 0.f);
    EXPECT_EQ(at(channel, 63, 63), 0.f);
  }
}

TEST(ImageTensor, HasAsManyRowsAsTheNetworkAsksFor) {
  ImageInputSpec spec = spec_of(ResizeRule::kLongSide);
  spec.row_step_px = 16;
  spec.rows_below_px = 3;
  const RgbImage image(64, 30, Rgb8{12, 28, 25});
  const FloatTensor tensor = image_tensor(image, spec);
  ASSERT_EQ(tensor.shape, (TensorShape{1, 3, 48, 64}));  // 30 and 3, in steps of 16
  ASSERT_EQ(tensor.values.size(), 3u * 48u * 64u);
  spec.row_step_px = 0;
  const FloatTensor square = image_tensor(image, spec);
  for (std::size_t channel = 0; channel < 3; ++channel)
    for (std::size_t i = 0; i < 48u * 64u; ++i)
      ASSERT_EQ(tensor.values[channel * 48 * 64 + i], square.values[channel * 64 * 64 + i]);
  EXPECT_EQ(image_tensor(RgbImage(8, 16), spec).shape, (TensorShape{1, 3, 64, 64}));
}

/// A horizontal ramp: the red value of a pixel is its column.
RgbImage ramp(int width, int height) {
  RgbImage image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.at(x, y).r = static_cast<std::uint8_t>(x);
  return image;
}

TEST(ImageTensor, ShortSideCutsTheLongOneAtBothEnds) {
  ImageInputSpec spec;
  spec.size_px = 10;
  spec.resize = ResizeRule::kShortSide;
  spec.std = {1, 1, 1};
  const FloatTensor same = image_tensor(ramp(17, 10), spec);  // no resize, 7 columns too many
  ASSERT_EQ(same.values.size(), 300u);
  for (std::size_t y = 0; y < 10; ++y)
    for (std::size_t x = 0; x < 10; ++x)
      ASSERT_EQ(same.values[y * 10 + x], static_cast<float>(x + 3));  // floor(7 / 2)
  const RgbImage tall = ramp(20, 45);  // becomes 10 x 22, cut from row 6 on
  const RgbImage small = resize_filtered(tall, 10, 22, ResizeFilter::kBicubic);
  spec.filter = ResizeFilter::kBicubic;
  const FloatTensor cut = image_tensor(tall, spec);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x)
      ASSERT_EQ(cut.values[static_cast<std::size_t>(y * 10 + x)],
                static_cast<float>(small.at(x, y + 6).r));
}

TEST(ImageTensor, ShortSideTakesVeryLongImages) {
  ImageInputSpec spec;
  spec.size_px = 32;
  spec.resize = ResizeRule::kShortSide;
  const FloatTensor tensor = image_tensor(RgbImage(100000, 1, Rgb8{255, 0, 255}), spec);
  EXPECT_NEAR(tensor.values.front(), 1.f, 1e-6);
  EXPECT_NEAR(tensor.values[32 * 32], 0.f, 1e-6);
}

}  // namespace
}  // namespace ovimap
