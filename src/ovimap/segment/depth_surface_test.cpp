// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/depth_surface.h"

#include <random>

#include <gtest/gtest.h>

#include "ovimap/segment/plain_segmentation.h"

namespace ovimap {
namespace {

const PinholeCamera kQqvgaCamera{160, 120, 150.f, 150.f, 79.5f, 59.5f};

/// Depth of the plane n . p = distance_m seen by kQqvgaCamera.
DepthImage plane(const Eigen::Vector3f& normal, float distance_m) {
  DepthImage depth(kQqvgaCamera.width, kQqvgaCamera.height);
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x)
      depth.at(x, y) = distance_m / normal.dot(kQqvgaCamera.unproject(static_cast<float>(x),
                                                                      static_cast<float>(y), 1.f));
  return depth;
}

TEST(DepthSurface, PlaneHasItsExactNormalEverywhere) {
  const Eigen::Vector3f normal = Eigen::Vector3f(0.3f, 0.5f, 0.8f).normalized();
  const DepthSurface surface = fit_depth_surface(plane(normal, 1.5f), kQqvgaCamera, {});
  for (int y = 0; y < kQqvgaCamera.height; ++y)
    for (int x = 0; x < kQqvgaCamera.width; ++x)
      ASSERT_NEAR(surface.normals.at(x, y).dot(-normal), 1.f, 1e-5f) << x << "," << y;
}

TEST(DepthSurface, EqualsThePlainFitOnNoisyDepthWithHolesAndSteps) {
  DepthImage depth = plane(Eigen::Vector3f(0.1f, 0.6f, 0.8f).normalized(), 1.2f);
  std::mt19937 random(7);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    depth[i] += 0.002f * (static_cast<float>(random() % 1000) / 1000.f - 0.5f);
    if (random() % 50 == 0) depth[i] = 0.f;
  }
  for (int y = 30; y < 60; ++y)
    for (int x = 40; x < 90; ++x) depth.at(x, y) *= 0.7f;
  for (const float radius_rad : {0.0135f, 0.04f}) {  // 2 and 6 pixels
    DepthSurfaceConfig config;
    config.normal_radius_rad = radius_rad;
    const DepthSurface surface = fit_depth_surface(depth, kQqvgaCamera, config);
    int compared = 0;
    for (int y = 0; y < depth.height(); ++y) {
      for (int x = 0; x < depth.width(); ++x) {
        ASSERT_EQ(surface.left_px.at(x, y), plain::arm(surface, x, y, -1, 0));
        ASSERT_EQ(surface.right_px.at(x, y), plain::arm(surface, x, y, 1, 0));
        ASSERT_EQ(surface.up_px.at(x, y), plain::arm(surface, x, y, 0, -1));
        ASSERT_EQ(surface.down_px.at(x, y), plain::arm(surface, x, y, 0, 1));
        const plain::Plane plane = plain::fit_plane(depth, surface, kQqvgaCamera, x, y);
        ASSERT_EQ(surface.normals.at(x, y).isZero(), plane.normal.isZero()) << x << "," << y;
        ASSERT_NEAR(surface.smooth_depth_m.at(x, y), plane.depth_m, 1e-5f) << x << "," << y;
        ASSERT_LT((surface.normals.at(x, y) - plane.normal).norm(), 1e-3f) << x << "," << y;
        ASSERT_NEAR(surface.plane_slope.at(x, y), plane.slope, 1e-3f) << x << "," << y;
        compared += !plane.normal.isZero();
      }
    }
    EXPECT_GT(compared, depth.width() * depth.height() / 2);
  }
}

TEST(DepthSurface, BreaksAtAStepAndNotOnASteepPlane) {
  const DepthSurface steep = fit_depth_surface(
      plane(Eigen::Vector3f(0.94f, 0.f, 0.34f).normalized(), 0.5f), kQqvgaCamera, {});
  EXPECT_EQ(steep.breaks.at(70, 60), 0);
  DepthImage depth = plane(Eigen::Vector3f::UnitZ(), 1.f);
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 80; x < depth.width(); ++x) depth.at(x, y) = 1.05f;
  const DepthSurface stepped = fit_depth_surface(depth, kQqvgaCamera, {});
  EXPECT_EQ(stepped.breaks.at(79, 60) & DepthSurface::kRight, DepthSurface::kRight);
  EXPECT_EQ(stepped.breaks.at(78, 60), 0);
  EXPECT_EQ(stepped.breaks.at(80, 60), 0);
}

TEST(DepthSurface, InvalidDepthHasNoSurface) {
  const DepthSurface surface = fit_depth_surface(DepthImage(32, 32), kQqvgaCamera, {});
  for (int y = 0; y < surface.normals.height(); ++y)
    for (int x = 0; x < surface.normals.width(); ++x)
      EXPECT_TRUE(surface.normals.at(x, y).isZero());
  for (float depth : surface.smooth_depth_m) EXPECT_EQ(depth, 0.f);
}

}  // namespace
}  // namespace ovimap
