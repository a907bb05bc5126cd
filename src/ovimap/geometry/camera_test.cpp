// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/geometry/camera.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

const PinholeCamera kCamera{640, 480, 500.f, 400.f, 320.f, 240.f};

TEST(PinholeCamera, ProjectsHandComputedPoints) {
  // x = 0.5 m at z = 2 m: 320 + 500 * 0.25 = 445; y = -1 m: 240 - 400 * 0.5 = 40.
  const Eigen::Vector2f pixel = kCamera.project({0.5f, -1.f, 2.f});
  EXPECT_FLOAT_EQ(pixel.x(), 445.f);
  EXPECT_FLOAT_EQ(pixel.y(), 40.f);
}

TEST(PinholeCamera, UnprojectInvertsProject) {
  const Eigen::Vector3f point(0.3f, -0.2f, 1.7f);
  const Eigen::Vector2f pixel = kCamera.project(point);
  EXPECT_TRUE(kCamera.unproject(pixel.x(), pixel.y(), point.z()).isApprox(point, 1e-6f));
}

TEST(PinholeCamera, ScalingKeepsTheRayOfAnImageCorner) {
  const PinholeCamera half = kCamera.scaled_to(320, 240);
  // The image's outer corner is (-0.5, -0.5) at every size.
  EXPECT_TRUE(
      half.unproject(-0.5f, -0.5f, 1.f).isApprox(kCamera.unproject(-0.5f, -0.5f, 1.f), 1e-6f));
}

TEST(PinholeCamera, RejectsImpossibleIntrinsics) {
  EXPECT_TRUE(kCamera.valid());
  PinholeCamera camera = kCamera;
  camera.fx = 0;
  EXPECT_FALSE(camera.valid());
  EXPECT_FALSE(PinholeCamera{}.valid());
}

}  // namespace
}  // namespace ovimap
