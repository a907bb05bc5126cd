// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/recording_check.h"

#include <random>

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"
#include "ovimap/segment/depth_surface.h"

namespace ovimap {
namespace {

constexpr float kWallAt_m = 2.f;

/// A camera before a wall two metres off, whose depth errs by so much in each pixel.
class NoisyWall final : public FrameSource {
 public:
  NoisyWall(float sigma_m, int width) : sigma_m_(sigma_m), width_(width) {}
  std::string kind() const override { return "wall"; }
  std::int64_t size() const override { return 30; }
  FrameRead read(std::int64_t position) const override {
    Frame frame;
    frame.depth_camera = {width_, width_ * 3 / 4,       570.f,
                          570.f,  0.5f * float(width_), 0.375f * float(width_)};
    frame.depth = DepthImage(width_, width_ * 3 / 4);
    std::mt19937 random(static_cast<unsigned>(position));
    std::normal_distribution<float> error(0.f, sigma_m_);
    for (float& depth_m : frame.depth) depth_m = kWallAt_m + error(random);
    if (position % 2 == 1) return {std::nullopt, "frame: is missing"};
    return {std::move(frame), {}};
  }

 private:
  float sigma_m_;
  int width_;
};

TEST(DepthErrors, AreThoseOfTheSensor) {
  for (const float sigma_m : {0.003f, 0.006f}) {
    const auto errors = measure_depth_errors(NoisyWall(sigma_m, 640), DepthSurfaceConfig{});
    ASSERT_EQ(errors.size(), 1u) << "all lies at one distance";
    EXPECT_EQ(errors[0].distance_m, kWallAt_m);
    EXPECT_NEAR(errors[0].pixel_m, sigma_m, 0.1f * sigma_m);
    EXPECT_NEAR(errors[0].surface_m, sigma_m / 13, 0.04f * sigma_m);  // windows of 13 x 13 pixels
  }
}

TEST(DepthErrors, AreNotToldBySmallImages) {
  EXPECT_TRUE(measure_depth_errors(NoisyWall(0.003f, 80), DepthSurfaceConfig{}).empty());
}

TEST(DepthErrors, ThreadsDoNotChangeThem) {
  const NoisyWall wall(0.005f, 320);
  const auto many = measure_depth_errors(wall, DepthSurfaceConfig{});
  const ThreadLimit one(1);
  const auto alone = measure_depth_errors(wall, DepthSurfaceConfig{});
  ASSERT_EQ(many.size(), alone.size());
  for (std::size_t i = 0; i < many.size(); ++i) {
    EXPECT_EQ(many[i].pixel_m, alone[i].pixel_m);
    EXPECT_EQ(many[i].surface_m, alone[i].surface_m);
  }
}

TEST(RecordingCheck, TellsTheNoiseOfARealSensor) {
  const std::filesystem::path kitchen = OVIMAP_SOURCE_DIR "/../shared/data/kitchen";
  if (!std::filesystem::exists(kitchen)) GTEST_SKIP() << "no kitchen recording at " << kitchen;
  const CheckReport report = check_recording(kitchen);
  EXPECT_TRUE(report.ok());
  ASSERT_GE(report.depth_errors.size(), 2u);
  EXPECT_EQ(report.findings.back().name, "noise");
  for (std::size_t i = 1; i < report.depth_errors.size(); ++i) {
    const DepthError &near = report.depth_errors[i - 1], &far = report.depth_errors[i];
    EXPECT_GT(far.pixel_m, near.pixel_m) << "as the square of the distance, of such a sensor";
    EXPECT_LT(far.surface_m, far.pixel_m);
  }
}

}  // namespace
}  // namespace ovimap
