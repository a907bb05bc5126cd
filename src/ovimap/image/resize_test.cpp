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

RgbImage noise_image(int width, int height) {
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

double cubic(double distance) {
  const double x = std::abs(distance);
  if (x >= 2) return 0;
  return x < 1 ? 1.5 * x * x * x - 2.5 * x * x + 1 : -0.5 * x * x * x + 2.5 * x * x - 4 * x + 2;
}

/// The definition, in two dimensions at once and in double precision.
double naive_red(const RgbImage& image, int width, int height, int x, int y,
                 double (*kernel)(double)) {
  const double sx = double(image.width()) / width, sy = double(image.height()) / height;
  const double cx = (x + 0.5) * sx - 0.5, cy = (y + 0.5) * sy - 0.5;
  double sum = 0, weights = 0;
  for (int v = 0; v < image.height(); ++v)
    for (int u = 0; u < image.width(); ++u) {
      const double weight =
          kernel((u - cx) / std::max(sx, 1.0)) * kernel((v - cy) / std::max(sy, 1.0));
      sum += weight * image.at(u, v).r;
      weights += weight;
    }
  return sum / weights;
}

TEST(Resize, AgreesWithTheDefinition) {
  RgbImage image = noise_image(41, 23);
  for (Rgb8& pixel : image) pixel.r = static_cast<std::uint8_t>(64 + pixel.r / 2);  // no clipping
  for (const auto& [width, height] :
       {std::pair{13, 9}, {80, 47}, {41, 7}, {3, 40}, {1, 1}, {41, 23}}) {
    const RgbImage linear = resize_bilinear(image, width, height);
    const RgbImage smooth = resize_filtered(image, width, height, ResizeFilter::kBicubic);
    ASSERT_EQ(linear.width(), width);
    ASSERT_EQ(linear.height(), height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        // Rounded twice; the cubic's weights amplify the first rounding to at most 5/4.
        ASSERT_NEAR(linear.at(x, y).r, naive_red(image, width, height, x, y, triangle), 1.001)
            << width << "x" << height << " at " << x << "," << y;
        ASSERT_NEAR(smooth.at(x, y).r, naive_red(image, width, height, x, y, cubic), 1.126)
            << width << "x" << height << " at " << x << "," << y;
      }
  }
}

/// The image the expected pixels below were made from.
RgbImage formula_image(int width, int height) {
  RgbImage image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.at(x, y) = {static_cast<std::uint8_t>(x * 37 + y * 91 + x * y * 5),
                        static_cast<std::uint8_t>(x * x * 11 + y * 53),
                        static_cast<std::uint8_t>((x ^ y) * 29 + (x + y) % 2 * 200)};
  return image;
}

// Image.fromarray(formula).resize((width, height), Image.BILINEAR / BICUBIC) of Pillow 12.2.
struct PillowCase {
  int from_width, from_height, width, height;
  ResizeFilter filter;
  std::vector<Rgb8> pixels;
};

std::vector<PillowCase> pillow_cases() {
  return {
      {13, 9, 5, 4, ResizeFilter::kBilinear, {{104, 65, 83},   {114, 126, 89},  {127, 129, 141},
                                              {128, 147, 149}, {141, 105, 77},  {117, 142, 83},
                                              {122, 108, 123}, {137, 139, 109}, {141, 128, 84},
                                              {130, 143, 166}, {108, 83, 127},  {135, 121, 121},
                                              {149, 136, 72},  {144, 141, 101}, {116, 84, 126},
                                              {119, 139, 149}, {118, 128, 68},  {139, 148, 103},
                                              {121, 149, 111}, {118, 179, 69}}},
      {13, 9, 5, 4, ResizeFilter::kBicubic, {{100, 55, 81},   {116, 133, 83},  {124, 121, 147},
                                             {127, 154, 159}, {145, 102, 65},  {121, 153, 76},
                                             {118, 101, 132}, {141, 147, 110}, {143, 123, 70},
                                             {131, 148, 183}, {105, 74, 131},  {137, 125, 123},
                                             {155, 136, 63},  {144, 147, 102}, {111, 68, 128},
                                             {118, 142, 157}, {114, 127, 60},  {143, 147, 103},
                                             {118, 148, 116}, {119, 190, 61}}},
      {5,
       4,
       9,
       7,
       ResizeFilter::kBilinear,
       {{0, 0, 0},       {12, 4, 76},    {33, 10, 204},  {53, 26, 153},   {74, 44, 58},
        {95, 75, 43},    {115, 108, 40}, {136, 150, 88}, {148, 176, 116}, {33, 19, 82},
        {45, 23, 104},   {67, 29, 140},  {88, 45, 103},  {110, 63, 48},   {132, 94, 44},
        {143, 127, 48},  {114, 169, 85}, {96, 195, 106}, {85, 49, 213},   {98, 53, 148},
        {121, 59, 38},   {145, 75, 24},  {168, 93, 33},  {191, 124, 46},  {187, 157, 60},
        {78, 199, 80},   {13, 225, 91},  {137, 80, 144}, {152, 84, 101},  {176, 90, 30},
        {144, 106, 16},  {98, 124, 16},  {122, 155, 87}, {133, 173, 142}, {86, 145, 136},
        {59, 128, 132},  {170, 110, 56}, {186, 114, 48}, {213, 120, 35},  {133, 136, 25},
        {27, 154, 16},   {53, 175, 125}, {80, 173, 208}, {106, 84, 185},  {122, 30, 172},
        {76, 140, 41},   {93, 144, 43},  {121, 150, 47}, {108, 166, 92},  {85, 184, 147},
        {113, 123, 111}, {141, 73, 90},  {169, 65, 132}, {185, 60, 157},  {17, 159, 31},
        {34, 163, 40},   {63, 169, 55},  {92, 185, 134}, {121, 203, 229}, {150, 91, 102},
        {179, 11, 16},   {208, 53, 98},  {225, 79, 147}}},
      {5,
       4,
       9,
       7,
       ResizeFilter::kBicubic,
       {{0, 0, 0},       {2, 0, 61},     {25, 5, 235},    {45, 19, 187},   {66, 40, 60},
        {85, 68, 25},    {108, 103, 34}, {145, 153, 93},  {163, 178, 125}, {23, 14, 82},
        {33, 16, 102},   {58, 23, 157},  {83, 37, 121},   {110, 58, 51},   {139, 85, 29},
        {146, 122, 37},  {115, 178, 84}, {101, 207, 111}, {81, 48, 243},   {94, 51, 164},
        {120, 58, 25},   {148, 72, 8},   {175, 93, 33},   {216, 120, 42},  {202, 157, 56},
        {65, 212, 78},   {3, 239, 91},   {149, 78, 171},  {168, 82, 116},  {198, 89, 11},
        {155, 102, 0},   {98, 124, 0},   {124, 170, 92},  {136, 192, 165}, {71, 148, 144},
        {43, 122, 130},  {173, 109, 53}, {197, 112, 48},  {230, 119, 35},  {137, 134, 10},
        {20, 154, 9},    {32, 192, 133}, {74, 185, 230},  {109, 72, 196},  {127, 7, 172},
        {66, 144, 31},   {86, 147, 34},  {119, 154, 44},  {106, 178, 103}, {85, 189, 159},
        {107, 121, 112}, {142, 60, 78},  {181, 54, 133},  {200, 54, 165},  {0, 162, 27},
        {16, 165, 31},   {49, 172, 49},  {88, 201, 157},  {129, 207, 247}, {159, 76, 95},
        {187, 0, 0},     {221, 49, 91},  {238, 91, 158}}},
  };
}

TEST(Resize, GivesThePixelsOfPillow) {
  for (const PillowCase& expected : pillow_cases()) {
    const RgbImage result =
        resize_filtered(formula_image(expected.from_width, expected.from_height), expected.width,
                        expected.height, expected.filter);
    EXPECT_EQ(std::vector<Rgb8>(result.begin(), result.end()), expected.pixels)
        << expected.width << "x" << expected.height;
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
  const RgbImage image = noise_image(30, 20);
  EXPECT_EQ(resize_bilinear(image, 30, 20), image);
}

TEST(ResizeBilinear, ThreadsDoNotChangeTheBits) {
  const RgbImage image = noise_image(200, 150);
  const RgbImage many = resize_bilinear(image, 64, 90);
  const ThreadLimit one(1);
  EXPECT_EQ(resize_bilinear(image, 64, 90), many);
}

TEST(Resize, AWindowIsAPartOfTheWhole) {
  const RgbImage image = noise_image(61, 47);
  for (const auto& [width, height] : {std::pair{20, 90}, {133, 31}}) {
    const RgbImage whole = resize_filtered(image, width, height, ResizeFilter::kBicubic);
    const ImageWindow window = {width - 13, 3, 13, height - 4};
    const RgbImage part = resize_window(image, width, height, window, ResizeFilter::kBicubic);
    ASSERT_EQ(part.width(), window.width_px);
    ASSERT_EQ(part.height(), window.height_px);
    for (int y = 0; y < part.height(); ++y)
      for (int x = 0; x < part.width(); ++x)
        ASSERT_EQ(part.at(x, y), whole.at(x + window.left_px, y + window.top_px));
  }
}

TEST(Resize, ImpossibleSizesAreRefused) {
  for (const ImageWindow& window :
       {ImageWindow{-1, 0, 2, 2}, {0, 0, 5, 2}, {3, 0, 2, 2}, {0, 0, 0, 2}, {0, 3, 1, 2}})
    EXPECT_THROW(resize_window(noise_image(4, 4), 4, 4, window, ResizeFilter::kBilinear), Error);
  EXPECT_THROW(resize_bilinear(noise_image(4, 4), 0, 3), Error);
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
