// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/images/track_pyramid.h"

#include <gtest/gtest.h>

#include <random>

namespace ovimap {
namespace {

/// A frame of any size with holes, steps and noise in depth, and colours of no order, black too.
Frame noise_frame(int width, int height) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> share(0, 1);
  Frame frame;
  frame.depth_camera = {width,
                        height,
                        0.9f * static_cast<float>(width),
                        0.9f * static_cast<float>(width),
                        0.5f * static_cast<float>(width) - 0.5f,
                        0.5f * static_cast<float>(height) - 0.5f};
  frame.color_camera = frame.depth_camera;
  frame.depth = DepthImage(width, height);
  frame.color = RgbImage(width, height);
  for (float& depth : frame.depth)
    depth =
        share(random) < 0.2f ? 0.f : (share(random) < 0.5f ? 1.f : 1.5f) + 0.02f * share(random);
  for (Rgb8& color : frame.color)
    if (share(random) > 0.3f)
      for (std::uint8_t* channel : {&color.r, &color.g, &color.b})
        *channel = static_cast<std::uint8_t>(255 * share(random));
  return frame;
}

/// As the pyramid says it: the mean of the depths of one surface, the nearest.
float plain_inverse(const Frame& frame, int x0, int y0, int side) {
  double nearest = 0, sum = 0, count = 0;
  const auto each = [&](const auto& take) {
    for (int y = y0; y < y0 + side; ++y)
      for (int x = x0; x < x0 + side; ++x)
        if (const float depth = frame.depth.row(y)[x]; depth > 0) take(1. / depth);
  };
  each([&](double inverse) { nearest = std::max(nearest, inverse); });
  each([&](double inverse) {
    if (inverse > (1 - kOneSurface) * nearest) sum += inverse, count += 1;
  });
  return count > 0 ? static_cast<float>(sum / count) : 0.f;
}

float plain_luma(const RgbImage& color, int x0, int y0, int side) {
  double sum = 0;
  for (int y = y0; y < y0 + side; ++y)
    for (int x = x0; x < x0 + side; ++x) {
      const Rgb8 at = color.row(y)[x];
      sum += 0.299 * at.r + 0.587 * at.g + 0.114 * at.b;
    }
  return sum > 0 ? static_cast<float>(sum / (side * side)) : -1.f;
}

class FinestLevel : public testing::TestWithParam<int> {};  // pixels of a frame to one of a level

TEST_P(FinestLevel, IsTheMeanOfWhatIsOneSurface) {
  const int side = GetParam(), width = 300 * side + side / 2 + 3;
  const Frame frame = noise_frame(width, 20 * side + 1);
  const TrackLevel level = make_pyramid(frame)[0];
  ASSERT_EQ(level.camera.width, width / side);
  for (int y = 0; y < level.camera.height; ++y)
    for (int x = 0; x < level.camera.width; ++x) {
      ASSERT_NEAR(level.inverse_depth.row(y)[x], plain_inverse(frame, x * side, y * side, side),
                  1e-5);
      ASSERT_NEAR(level.intensity.row(y)[x], plain_luma(frame.color, x * side, y * side, side),
                  1e-3);
    }
}

INSTANTIATE_TEST_SUITE_P(Sides, FinestLevel, testing::Values(1, 2, 3));

TEST(TrackPyramid, TakesIntensityFromWhereTheColorCameraSawThePoint) {
  Frame frame = noise_frame(602, 40);
  frame.color_camera.fx = 700, frame.color_camera.cx = 290;
  frame.color_from_depth.translation() = Eigen::Vector3d(0.03, 0.002, -0.01);
  ASSERT_FALSE(frame.registered());
  const TrackLevel level = make_pyramid(frame)[0];
  std::size_t known = 0, off = 0;
  for (int y = 0; y < level.camera.height; ++y)
    for (int x = 0; x < level.camera.width; ++x) {
      const float inverse = level.inverse_depth.row(y)[x], found = level.intensity.row(y)[x];
      float expected = -1;
      if (inverse > 0) {
        const Eigen::Vector2f pixel = frame.color_camera.project(
            frame.color_from_depth.cast<float>() *
            level.camera.unproject(static_cast<float>(x), static_cast<float>(y), 1 / inverse));
        if (pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < 601 && pixel.y() < 39)
          expected =
              plain_luma(frame.color, static_cast<int>(pixel.x()), static_cast<int>(pixel.y()), 2);
      }
      known += expected >= 0, off += std::fabs(expected - found) > 1e-3f;
    }
  EXPECT_GT(known, 3000U);
  EXPECT_LE(off, known / 1000);  // a hair from a pixel's edge
}

TEST(TrackPyramid, HalvesUntilTheNextWouldBeTooNarrow) {
  const TrackPyramid pyramid = make_pyramid(noise_frame(640, 48));
  ASSERT_EQ(pyramid.size(), 4U);
  EXPECT_EQ(pyramid[3].camera.width, kCoarsestWidth_px);
  EXPECT_EQ(pyramid[3].inverse_depth.height(), 3);
}

}  // namespace
}  // namespace ovimap
