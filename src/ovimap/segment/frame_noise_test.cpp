// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/frame_noise.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "ovimap/segment/depth_surface.h"

namespace ovimap {
namespace {

const PinholeCamera kVgaCamera{640, 480, 570.f, 570.f, 319.5f, 239.5f};
constexpr float kDepth_m = 2.f;

/// A wall at a slant whose errors are those of cells of so many pixels; between them, what lies
/// there.
DepthImage wall(float cell_px, float times, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  Image<float> cells(kVgaCamera.width + 2, kVgaCamera.height + 2);
  for (float& cell : cells) cell = normal(random);
  DepthImage depth(kVgaCamera.width, kVgaCamera.height);
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x) {
      const Eigen::Vector3f ray =
          kVgaCamera.unproject(static_cast<float>(x), static_cast<float>(y), 1.f);
      const float z = kDepth_m / Eigen::Vector3f(0.1f, 0.05f, 1.f).dot(ray);
      const float u = static_cast<float>(x) / cell_px, v = static_cast<float>(y) / cell_px;
      const int left = static_cast<int>(u), top = static_cast<int>(v);
      const float fx = u - std::floor(u), fy = v - std::floor(v);
      float error = 0, squares = 0;
      for (const int dy : {0, 1})
        for (const int dx : {0, 1}) {
          const float weight = (dx ? fx : 1 - fx) * (dy ? fy : 1 - fy);
          error += weight * cells.at(left + dx, top + dy);
          squares += weight * weight;
        }
      depth.at(x, y) = z + times * DepthNoiseConfig{}.sigma_m(z) * error / std::sqrt(squares);
    }
  return depth;
}

FrameNoise noise_of(const DepthImage& depth) {
  return fit_depth_surface(depth, kVgaCamera, {}).noise;
}

TEST(FrameNoise, PlanesAverageErrorsThatPixelsDoNotShare) {
  const FrameNoise noise = noise_of(wall(1.f, 1.f, 1));
  EXPECT_NEAR(noise.pixel.at(kDepth_m), 1.f, 0.1f);
  EXPECT_NEAR(noise.plane.at(kDepth_m), 1.f / 13, 0.04f);  // windows of 13 x 13 pixels
  EXPECT_NEAR(noise.normal.at(kDepth_m), 1.f, 0.15f);
}

TEST(FrameNoise, SeesWhatNeighboursShare) {
  for (const float times : {1.f, 2.f}) {
    const FrameNoise noise = noise_of(wall(8.f, times, 2));
    EXPECT_GT(noise.plane.at(kDepth_m), 0.5f * times);
    EXPECT_LT(noise.plane.at(kDepth_m), 1.2f * times);
    EXPECT_GT(noise.normal.at(kDepth_m), 2.f * times)
        << "planes tilt with what a part of them shares";
  }
}

TEST(FrameNoise, PlanesOfExactDepthAreGood) {
  EXPECT_LT(noise_of(wall(1.f, 0.f, 3)).plane.at(kDepth_m), 0.05f);
}

TEST(FrameNoise, WhereAFrameDoesNotTellPlanesErrAsPixelsDo) {
  const PinholeCamera camera{24, 18, 22.f, 22.f, 11.5f, 8.5f};
  const DepthImage depth(24, 18, kDepth_m);
  const FrameNoise noise = fit_depth_surface(depth, camera, {}).noise;
  EXPECT_EQ(noise.pixel.at(kDepth_m), 1.f);
  EXPECT_EQ(noise.plane.at(kDepth_m), 1.f);
  EXPECT_EQ(noise.normal.at(kDepth_m), 1.f);
}

/// Shelves in front of a wall, each of its own depth.
TEST(FrameNoise, StepsBetweenSurfacesAreNoNoise) {
  DepthImage depth = wall(1.f, 1.f, 4);
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x) depth.at(x, y) += 0.2f * static_cast<float>(x / 60 % 3);
  EXPECT_LT(noise_of(depth).plane.at(kDepth_m), 0.2f);
}

TEST(ByRange, HalfOctaves) {
  EXPECT_EQ(ByRange::range_of(0.01f), 0u);
  EXPECT_EQ(ByRange::range_of(0.13f), 0u);
  EXPECT_EQ(ByRange::range_of(0.19f), 1u);
  EXPECT_EQ(ByRange::range_of(2.f), 8u);
  EXPECT_EQ(ByRange::range_of(1e9f), ByRange::kRanges - 1);
}

}  // namespace
}  // namespace ovimap
