// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/image/resize.h"

#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"

namespace ovimap {
namespace {

RgbImage random_rgb(int width, int height) {
  std::mt19937 random(5);
  RgbImage image(width, height);
  for (Rgb8& pixel : image)
    pixel = {static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()),
             static_cast<std::uint8_t>(random())};
  return image;
}

double triangle(double distance) {
  return std::max(0.0, 1.0 - std::abs(distance));
}

/// The definition, in two dimensions at once and in double precision.
double naive_red(const RgbImage& image, int width, int height, int x, int y) {
  const double sx = double(image.width()) / width, sy = double(image.height()) / height;
  const double cx = (x + 0.5) * sx - 0.5, cy = (y + 0.5) * sy - 0.5;
  double sum = 0, weights = 0;
  for (int v = 0; v < image.height(); ++v)
    for (int u = 0; u < image.width(); ++u) {
      const double weight =
          triangle((u - cx) / std::max(sx, 1.0)) * triangle((v - cy) / std::max(sy, 1.0));
      sum += weight * image.at(u, v).r;
      weights += weight;
    }
  return sum / weights;
}

TEST(ResizeBilinear, AgreesWithTheDefinition) {
  const RgbImage image = random_rgb(41, 23);
  for (const auto& [width, height] :
       {std::pair{13, 9}, {80, 47}, {41, 7}, {3, 40}, {1, 1}, {41, 23}}) {
    const RgbImage result = resize_bilinear(image, width, height);
    ASSERT_EQ(result.width(), width);
    ASSERT_EQ(result.height(), height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        ASSERT_NEAR(result.at(x, y).r, naive_red(image, width, height, x, y), 0.501)
            << width << "x" << height << " at " << x << "," << y;
  }
}

TEST(ResizeBilinear, HandComputedHalving) {
  // Output 0 of a 4-wide row at half size: centre 0.5, triangle radius 2, weights .75 .75 .25
  // (sum 1.75).
  RgbImage image(4, 1);
  image.at(0, 0) = {0, 70, 255};
  image.at(1, 0) = {70, 70, 255};
  image.at(2, 0) = {140, 0, 255};
  image.at(3, 0) = {210, 0, 255};
  const RgbImage half = resize_bilinear(image, 2, 1);
  EXPECT_EQ(half.at(0, 0), (Rgb8{50, 60, 255}));  // (70*.75 + 140*.25)/1.75 = 50; 70*1.5/1.75 = 60
  EXPECT_EQ(half.at(1, 0).r, 160);
}

TEST(ResizeBilinear, SameSizeIsTheSameImage) {
  const RgbImage image = random_rgb(30, 20);
  EXPECT_EQ(resize_bilinear(image, 30, 20), image);
}

TEST(ResizeBilinear, ThreadsDoNotChangeTheBits) {
  const RgbImage image = random_rgb(200, 150);
  const RgbImage many = resize_bilinear(image, 64, 90);
  const ThreadLimit one(1);
  EXPECT_EQ(resize_bilinear(image, 64, 90), many);
}

TEST(Resize, ImpossibleSizesAreRefused) {
  EXPECT_THROW(resize_bilinear(random_rgb(4, 4), 0, 3), Error);
  EXPECT_THROW(resize_bilinear(RgbImage(), 3, 3), Error);
  EXPECT_THROW(resize_nearest(IdImage(4, 4), 3, -1), Error);
  EXPECT_THROW(resize_nearest(IdImage(), 3, 3), Error);
}

TEST(ResizeNearest, TakesThePixelUnderTheCentre) {
  IdImage image(4, 2);
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<std::uint16_t>(10 + i);
  const IdImage half = resize_nearest(image, 2, 1);  // centres at x = 1, 3 and y = 1
  EXPECT_EQ(half.at(0, 0), image.at(1, 1));
  EXPECT_EQ(half.at(1, 0), image.at(3, 1));
  const IdImage twice = resize_nearest(image, 8, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) EXPECT_EQ(twice.at(x, y), image.at(x / 2, y / 2));
}

TEST(ResizeNearest, InventsNoId) {
  std::mt19937 random(3);
  IdImage image(31, 17);
  std::set<std::uint16_t> ids;
  for (std::uint16_t& id : image) ids.insert(id = static_cast<std::uint16_t>(random() % 3 * 20000));
  for (const std::uint16_t id : resize_nearest(image, 77, 50)) EXPECT_TRUE(ids.contains(id));
}

}  // namespace
}  // namespace ovimap
