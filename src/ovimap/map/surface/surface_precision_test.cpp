// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/surface/surface_precision.h"

#include <cmath>

#include <gtest/gtest.h>

#include "ovimap/map/fusion/integrate.h"

namespace ovimap {
namespace {

const PinholeCamera kSmallCamera{64, 48, 60.f, 60.f, 31.5f, 23.5f};

/// A wall at a metre, seen so often by a sensor that errs so much.
VoxelMap wall_map(int frames, float sigma_m) {
  VoxelMap map;
  const DepthImage depth(kSmallCamera.width, kSmallCamera.height, 1.f);
  const Image<float> slope(kSmallCamera.width, kSmallCamera.height, 1.f),
      sigma(kSmallCamera.width, kSmallCamera.height, sigma_m);
  for (int i = 0; i < frames; ++i)
    integrate(map, {.depth = depth,
                    .camera = kSmallCamera,
                    .world_from_camera = Pose::Identity(),
                    .plane_slope = &slope,
                    .sigma_m = &sigma});
  return map;
}

std::optional<float> error_before_camera(const VoxelMap& map) {
  const VoxelBlock* block = map.find({0, 0, 12});
  return block ? surface_error_m(map, *block) : std::nullopt;
}

TEST(SurfacePrecision, MoreAndBetterLooksMakeItSmaller) {
  const float one = *error_before_camera(wall_map(1, 0.01f)),
              four = *error_before_camera(wall_map(4, 0.01f)),
              better = *error_before_camera(wall_map(1, 0.001f));
  EXPECT_NEAR(four, one / 2, 0.01f * one);
  EXPECT_LT(better, one);
  EXPECT_NEAR(one, std::sqrt(0.01f * 0.01f + 0.005f * 0.005f), 0.001f)
      << "the sensor's error and half a voxel";
}

TEST(SurfacePrecision, IsUnknownWhereTheMeshShowsNothing) {
  VoxelMap empty;
  EXPECT_FALSE(surface_error_m(empty, empty.block(empty.find_or_create({0, 0, 0}))));
  EXPECT_FALSE(error_before_camera(wall_map(1, 0.05f))) << "a standard error of five voxels";
}

TEST(SurfacePrecision, GoesIntoAByteAndBack) {
  EXPECT_EQ(error_byte(std::nullopt), 0);
  EXPECT_EQ(error_byte(0.f), 1) << "0 is what is not known";
  EXPECT_EQ(error_byte(1.f), 255);
  for (const float error_m : {0.001f, 0.0052f, 0.03f})
    EXPECT_NEAR(error_of_byte(error_byte(error_m)), error_m, 1.01e-4f);
}

}  // namespace
}  // namespace ovimap
