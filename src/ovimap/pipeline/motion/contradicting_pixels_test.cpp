// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/motion/contradicting_pixels.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"
#include "ovimap/pipeline/motion/frame_points.h"

namespace ovimap {
namespace {

/// Pixel by pixel.
Image<std::uint8_t> plain_contradicting_pixels(const VoxelMapConfig& map, const SeenFree& space,
                                               const Observation& seen,
                                               const MotionConfig& config) {
  const FramePoints points(seen);
  const auto empty_at = [&](int x, int y, float depth_m) {
    return space.at(block_at(points.at(x, y, depth_m), 1.f / map.block_size_m())).looks >=
           config.looks;
  };
  Image<std::uint8_t> result(seen.depth.width(), seen.depth.height());
  for (int y = 0; y < seen.depth.height(); ++y)
    for (int x = 0; x < seen.depth.width(); ++x) {
      const float depth_m = seen.depth.at(x, y), fitted = seen.plane_slope->at(x, y);
      const float slope = fitted > 0.f ? std::max(fitted, 0.1f) : 0.5f;
      const float margin_m = std::max(config.margin_voxels * map.voxel_size_m / slope,
                                      config.sigmas * seen.sigma_m->at(x, y));
      result.at(x, y) =
          depth_m > 0.f && empty_at(x, y, depth_m) && empty_at(x, y, depth_m + margin_m);
    }
  return result;
}

/// Space that was seen empty to 2.5 m, and a frame of another pose whose depth lies in and behind
/// that, with holes and slopes of all kinds. The width is no multiple of what is worked on at once.
struct RoughFrame {
  PinholeCamera camera{157, 120, 150.f, 150.f, 78.f, 59.5f};
  VoxelMapConfig map;
  MotionConfig config;
  SeenFree space;
  DepthImage depth{157, 120, 3.f};
  Image<float> slope{157, 120, 1.f}, sigma{157, 120, 0.004f};
  Pose pose = Pose::Identity();

  RoughFrame() {
    const Image<float> free_m(camera.width, camera.height, 2.5f);
    for (int i = 0; i < config.looks; ++i) space.look(camera, pose, free_m, map.block_size_m());
    pose.linear() = Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
    std::uint32_t random = 5;
    for (std::size_t i = 0; i < depth.size(); ++i) {
      random = random * 1664525u + 1013904223u;
      const auto part = static_cast<float>(random >> 8) / 16777216.f;
      if (i / 157 % 40 < 20) depth[i] = 1.2f + 0.01f * static_cast<float>(i % 157);
      if (i / 157 % 40 == 30) depth[i] = 0.5f + 3.f * part;
      if (part < 0.02f) depth[i] = 0.f;
      slope[i] = std::max(0.f, 1.2f * part - 0.1f);
      sigma[i] = 0.02f * part;
    }
  }
  Observation seen() const {
    return {.depth = depth,
            .camera = camera,
            .world_from_camera = pose,
            .plane_slope = &slope,
            .sigma_m = &sigma};
  }
};

TEST(ContradictingPixels, AreThoseThatThePlainWayFinds) {
  const RoughFrame rough;
  const Image<std::uint8_t> found =
      contradicting_pixels(rough.map, rough.space, rough.seen(), rough.config);
  EXPECT_EQ(found, plain_contradicting_pixels(rough.map, rough.space, rough.seen(), rough.config));
  const auto count = std::count(found.begin(), found.end(), 1);
  EXPECT_GT(count, 1000);
  EXPECT_LT(count, 12000);
  const ThreadLimit limit(1);
  EXPECT_EQ(found, contradicting_pixels(rough.map, rough.space, rough.seen(), rough.config));
}

}  // namespace
}  // namespace ovimap
