// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/depth_surface.h"

#include <random>

#include <Eigen/Cholesky>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

const PinholeCamera kCamera{160, 120, 150.f, 150.f, 79.5f, 59.5f};

/// Depth of the plane n . p = distance_m seen by kCamera.
DepthImage plane(const Eigen::Vector3f& normal, float distance_m) {
  DepthImage depth(kCamera.width, kCamera.height);
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x)
      depth.at(x, y) = distance_m / normal.dot(kCamera.unproject(static_cast<float>(x),
                                                                 static_cast<float>(y), 1.f));
  return depth;
}

/// The same sums gathered pixel by pixel over the rows' unbroken windows: what the fast path must
/// equal.
Eigen::Vector3f naive_normal(const DepthImage& depth, const DepthSurface& surface, int x, int y) {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  const auto add_row = [&](int row) {
    for (int u = x - surface.left_px.at(x, row); u <= x + surface.right_px.at(x, row); ++u) {
      const Eigen::Vector3d basis(u - x, row - y, 1);
      a += basis * basis.transpose();
      b += basis / depth.at(u, row);
    }
  };
  add_row(y);
  for (int row = y - 1; row >= std::max(0, y - surface.radius_px); --row) {
    if (surface.breaks.at(x, row) & DepthSurface::kBelow) break;
    add_row(row);
  }
  for (int row = y + 1; row <= std::min(depth.height() - 1, y + surface.radius_px); ++row) {
    if (surface.breaks.at(x, row - 1) & DepthSurface::kBelow) break;
    add_row(row);
  }
  const Eigen::Vector3d fit = a.ldlt().solve(b);
  const Eigen::Vector3d normal(fit.x() * kCamera.fx, fit.y() * kCamera.fy,
                               fit.z() + fit.x() * (kCamera.cx - x) + fit.y() * (kCamera.cy - y));
  return -normal.normalized().cast<float>();
}

TEST(DepthSurface, PlaneHasItsExactNormalEverywhere) {
  const Eigen::Vector3f normal = Eigen::Vector3f(0.3f, 0.5f, 0.8f).normalized();
  const DepthSurface surface = fit_depth_surface(plane(normal, 1.5f), kCamera, {});
  for (int y = 0; y < kCamera.height; ++y)
    for (int x = 0; x < kCamera.width; ++x)
      ASSERT_NEAR(surface.normals.at(x, y).dot(-normal), 1.f, 1e-5f) << x << "," << y;
}

TEST(DepthSurface, MatchesThePixelwiseFitOnNoisyDepthWithHolesAndSteps) {
  DepthImage depth = plane(Eigen::Vector3f(0.1f, 0.6f, 0.8f).normalized(), 1.2f);
  std::mt19937 random(7);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    depth[i] += 0.002f * (static_cast<float>(random() % 1000) / 1000.f - 0.5f);
    if (random() % 50 == 0) depth[i] = 0.f;
  }
  for (int y = 30; y < 60; ++y)
    for (int x = 40; x < 90; ++x) depth.at(x, y) *= 0.7f;
  const DepthSurface surface = fit_depth_surface(depth, kCamera, {});
  int compared = 0;
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      if (surface.normals.at(x, y).isZero()) continue;
      ASSERT_NEAR(surface.normals.at(x, y).dot(naive_normal(depth, surface, x, y)), 1.f, 2e-4f)
          << x << "," << y;
      ++compared;
    }
  }
  EXPECT_GT(compared, depth.width() * depth.height() / 2);
}

TEST(DepthSurface, BreaksAtAStepAndNotOnASteepPlane) {
  const DepthSurface steep =
      fit_depth_surface(plane(Eigen::Vector3f(0.94f, 0.f, 0.34f).normalized(), 0.5f), kCamera, {});
  EXPECT_EQ(steep.breaks.at(70, 60), 0);
  DepthImage depth = plane(Eigen::Vector3f::UnitZ(), 1.f);
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 80; x < depth.width(); ++x) depth.at(x, y) = 1.05f;
  const DepthSurface stepped = fit_depth_surface(depth, kCamera, {});
  EXPECT_EQ(stepped.breaks.at(79, 60) & DepthSurface::kRight, DepthSurface::kRight);
  EXPECT_EQ(stepped.breaks.at(78, 60), 0);
  EXPECT_EQ(stepped.breaks.at(80, 60), 0);
}

TEST(DepthSurface, InvalidDepthHasNoSurface) {
  const DepthSurface surface = fit_depth_surface(DepthImage(32, 32), kCamera, {});
  for (const auto& normal : surface.normals) EXPECT_TRUE(normal.isZero());
  for (float depth : surface.smooth_depth_m) EXPECT_EQ(depth, 0.f);
}

}  // namespace
}  // namespace ovimap
