// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/frame/registration.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"

namespace ovimap {
namespace {

const PinholeCamera kDepthCamera{64, 48, 60.f, 60.f, 31.5f, 23.5f};

Frame flat_frame(float depth_m) {
  Frame frame;
  frame.depth_camera = frame.color_camera = kDepthCamera;
  frame.depth = DepthImage(64, 48, depth_m);
  frame.color = RgbImage(64, 48);
  return frame;
}

/// The definition, pixel by pixel in double precision; occlusion by comparing all pairs that share
/// a pixel.
Image<std::int32_t> naive_index(const Frame& frame, double margin_m) {
  const int width = frame.depth.width(), height = frame.depth.height();
  Image<std::int32_t> index(width, height, Registration::kNoColor);
  Image<double> z(width, height),
      nearest(frame.color_camera.width, frame.color_camera.height, 1e30);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      if (!(frame.depth.at(u, v) > 0)) continue;
      const Eigen::Vector3d point =
          frame.color_from_depth *
          frame.depth_camera.unproject(float(u), float(v), frame.depth.at(u, v)).cast<double>();
      if (point.z() <= 0) continue;
      const PinholeCamera& color = frame.color_camera;
      const int x = static_cast<int>(std::floor(color.fx * point.x() / point.z() + color.cx + 0.5));
      const int y = static_cast<int>(std::floor(color.fy * point.y() / point.z() + color.cy + 0.5));
      if (!nearest.contains(x, y)) continue;
      index.at(u, v) = y * color.width + x;
      z.at(u, v) = point.z();
      nearest.at(x, y) = std::min(nearest.at(x, y), point.z());
    }
  for (std::size_t i = 0; i < index.size(); ++i)
    if (index[i] >= 0 && nearest[static_cast<std::size_t>(index[i])] < z[i] - margin_m)
      index[i] = Registration::kNoColor;
  return index;
}

TEST(Registration, RegisteredFrameIsTheIdentityWhereDepthIsValid) {
  Frame frame = flat_frame(2.f);
  frame.depth.at(5, 7) = 0;
  const Registration registration(frame);
  for (std::size_t i = 0; i < frame.depth.size(); ++i)
    EXPECT_EQ(registration.color_index()[i],
              i == 7u * 64u + 5u ? Registration::kNoColor : std::int32_t(i));
}

TEST(Registration, SidewaysOffsetMovesByFocalTimesBaselineOverDepth) {
  Frame frame = flat_frame(2.f);
  frame.color_from_depth.translation().x() = 0.1;  // 60 * 0.1 / 2 = 3 pixels to the right
  const Registration registration(frame);
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u)
      ASSERT_EQ(registration.color_index().at(u, v),
                u + 3 < 64 ? v * 64 + u + 3 : Registration::kNoColor);
}

TEST(Registration, NearerSurfaceHidesWhatLiesBehindIt) {
  // A wall at 3 m, and columns 30..39 at 1 m. With f*b = 3 they move by 1 and by 3 pixels, so the
  // wall's columns 40 and 41 fall on colour columns 41 and 42, where the near columns 38 and 39
  // fall as well.
  Frame frame = flat_frame(3.f);
  for (int v = 0; v < 48; ++v)
    for (int u = 30; u < 40; ++u) frame.depth.at(u, v) = 1.f;
  frame.color_from_depth.translation().x() = 0.05;
  const Registration registration(frame);
  for (int v = 0; v < 48; ++v) {
    EXPECT_EQ(registration.color_index().at(35, v), v * 64 + 38);
    EXPECT_EQ(registration.color_index().at(39, v), v * 64 + 42);
    EXPECT_EQ(registration.color_index().at(40, v), Registration::kNoColor);
    EXPECT_EQ(registration.color_index().at(41, v), Registration::kNoColor);
    EXPECT_EQ(registration.color_index().at(42, v), v * 64 + 43);
  }
  const Registration lenient(frame, 2.5f);
  EXPECT_EQ(lenient.color_index().at(40, 0), 41);
}

TEST(Registration, FinerColourCameraStillSeesOcclusion) {
  // Colour of four times the resolution: the points of the near surface do not touch each other
  // there.
  Frame frame = flat_frame(3.f);
  frame.color_camera = kDepthCamera.scaled_to(256, 192);
  frame.color = RgbImage(256, 192);
  for (int v = 0; v < 48; ++v)
    for (int u = 30; u < 40; ++u) frame.depth.at(u, v) = 1.f;
  frame.color_from_depth.translation().x() = 0.05;
  const Registration registration(frame);
  for (int v = 0; v < 48; ++v) {
    EXPECT_EQ(registration.color_index().at(40, v), Registration::kNoColor);
    EXPECT_NE(registration.color_index().at(38, v), Registration::kNoColor);
    EXPECT_NE(registration.color_index().at(44, v), Registration::kNoColor);
  }
}

Frame random_frame() {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> depth(-0.5f, 4.f);
  Frame frame = flat_frame(0);
  for (float& value : frame.depth) value = std::max(0.f, depth(random));
  frame.color_camera = {50, 40, 45.f, 44.f, 26.f, 19.f};
  frame.color = RgbImage(50, 40);
  frame.color_from_depth.linear() =
      Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  frame.color_from_depth.translation() = Eigen::Vector3d(0.07, -0.04, -0.3);
  return frame;
}

TEST(Registration, AgreesWithTheDefinitionOnRandomDepth) {
  const Frame frame = random_frame();
  const Registration registration(frame);
  const Image<std::int32_t> expected = naive_index(frame, 0.05);
  std::size_t different = 0, hidden = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    different += registration.color_index()[i] != expected[i] ? 1 : 0;
    hidden += expected[i] < 0 && frame.depth[i] > 0 ? 1 : 0;
  }
  EXPECT_LE(different, 2u);  // only points on the very border between two pixels may round apart
  EXPECT_GT(hidden, 100u);
}

TEST(Registration, ThreadsDoNotChangeTheResult) {
  const Frame frame = random_frame();
  const Registration many(frame);
  const ThreadLimit one(1);
  EXPECT_EQ(Registration(frame).color_index(), many.color_index());
}

TEST(Registration, LooksUpColoursAndIds) {
  Frame frame = flat_frame(2.f);
  frame.color_from_depth.translation().x() = 0.1;
  RgbImage color(64, 48);
  IdImage ids(64, 48);
  for (int x = 0; x < 64; ++x) {
    color.at(x, 9) = {static_cast<std::uint8_t>(x), 1, 2};
    ids.at(x, 9) = static_cast<std::uint16_t>(1000 + x);
  }
  const Registration registration(frame);
  EXPECT_EQ(registration.color_at_depth(color).at(20, 9), (Rgb8{23, 1, 2}));
  EXPECT_EQ(registration.ids_at_depth(ids).at(20, 9), 1023);
  EXPECT_EQ(registration.ids_at_depth(ids).at(62, 9), 0);
}

}  // namespace
}  // namespace ovimap
