// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/depth_estimate.h"

#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"

namespace ovimap {
namespace {

const PinholeCamera kCamera{320, 240, 285.f, 285.f, 159.5f, 119.5f};

/// Depth of the plane n . p = distance_m, and of a second one where that is nearer.
DepthImage two_planes(const Eigen::Vector3f& a, float a_m, const Eigen::Vector3f& b, float b_m) {
  DepthImage depth(kCamera.width, kCamera.height);
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x) {
      const Eigen::Vector3f ray =
          kCamera.unproject(static_cast<float>(x), static_cast<float>(y), 1.f);
      const float at_a = a_m / a.dot(ray), at_b = b.dot(ray) > 0.f ? b_m / b.dot(ray) : 1e9f;
      depth.at(x, y) = std::min(at_a, at_b);
    }
  return depth;
}

DepthImage wall(float distance_m) {
  const Eigen::Vector3f normal = Eigen::Vector3f(0.2f, 0.3f, 0.9f).normalized();
  return two_planes(normal, distance_m, normal, distance_m);
}

/// Two walls that meet in an edge towards the camera.
DepthImage corner(float distance_m) {
  return two_planes(Eigen::Vector3f(0.7f, 0.f, 0.7f).normalized(), distance_m,
                    Eigen::Vector3f(-0.7f, 0.f, 0.7f).normalized(), distance_m);
}

DepthImage with_noise(DepthImage depth, const DepthNoiseConfig& noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  for (float& z : depth) z += noise.sigma_m(z) * normal(random);
  return depth;
}

DepthEstimate estimate(const DepthImage& depth, const DepthEstimateConfig& config = {}) {
  const DepthNoiseConfig noise;
  return estimate_depth(depth, fit_depth_surface(depth, kCamera, {}), noise, config);
}

/// Root mean square difference.
float error_m(const DepthImage& depth, const DepthImage& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < depth.size(); ++i)
    sum += (depth[i] - truth[i]) * (depth[i] - truth[i]);
  return static_cast<float>(std::sqrt(sum / static_cast<double>(depth.size())));
}

TEST(DepthEstimate, TakesMostNoiseOffAWallAndSaysHowMuchIsLeft) {
  const DepthImage truth = wall(3.f), noisy = with_noise(truth, {}, 1);
  const DepthEstimate found = estimate(noisy);
  EXPECT_LT(error_m(found.depth_m, truth), 0.35f * error_m(noisy, truth));
  EXPECT_LT(found.sigma_m.at(160, 120), 0.6f * DepthNoiseConfig{}.sigma_m(truth.at(160, 120)));
}

TEST(DepthEstimate, ReadsTheNoiseOffTheFrameWhateverTheModelSays) {
  const auto mean_sigma = [](float times) {
    DepthNoiseConfig noise;
    noise.base_m *= times, noise.quadratic_per_m *= times;
    const DepthEstimate found = estimate(with_noise(wall(1.5f), noise, 2));
    return std::accumulate(found.sigma_m.begin(), found.sigma_m.end(), 0.) /
           static_cast<double>(found.sigma_m.size());
  };
  const double usual = mean_sigma(1.f);
  EXPECT_NEAR(mean_sigma(0.25f) / usual, 0.25, 0.05);
  EXPECT_NEAR(mean_sigma(1.5f) / usual, 1.5, 0.3);
}

TEST(DepthEstimate, LeavesExactDepthAsItIsAlsoAtAnEdge) {
  for (const DepthImage& truth : {wall(2.f), corner(2.f)}) {
    const DepthEstimate found = estimate(truth);
    for (std::size_t i = 0; i < truth.size(); ++i)
      ASSERT_NEAR(found.depth_m[i], truth[i], 0.0015f) << i;
  }
}

TEST(DepthEstimate, RoundsAnEdgeLessThanThePlanesDo) {
  const DepthImage truth = corner(2.f), noisy = with_noise(truth, {}, 3);
  const DepthSurface surface = fit_depth_surface(noisy, kCamera, {});
  const DepthEstimate found = estimate_depth(noisy, surface, {}, {});
  double of_planes = 0, of_estimate = 0;  // signed: noise averages out, rounding does not
  for (int y = 20; y < 220; ++y) {
    of_planes += surface.smooth_depth_m.at(159, y) - truth.at(159, y);
    of_estimate += found.depth_m.at(159, y) - truth.at(159, y);
  }
  EXPECT_LT(std::abs(of_estimate), 0.8 * std::abs(of_planes));
  EXPECT_LT(error_m(found.depth_m, truth), error_m(noisy, truth));
}

TEST(DepthEstimate, HolesStayHolesAndLonePixelsAsMeasured) {
  DepthImage depth = with_noise(wall(2.f), {}, 4);
  for (int y = 100; y < 110; ++y)
    for (int x = 100; x < 110; ++x) depth.at(x, y) = 0.f;
  depth.at(105, 105) = 1.f;
  const DepthEstimate found = estimate(depth);
  EXPECT_EQ(found.depth_m.at(102, 102), 0.f);
  EXPECT_EQ(found.sigma_m.at(102, 102), 0.f);
  EXPECT_EQ(found.depth_m.at(105, 105), 1.f);
  EXPECT_GT(found.sigma_m.at(105, 105), 0.f);
}

TEST(DepthEstimate, SwitchedOffItIsWhatWasMeasured) {
  const DepthImage depth = with_noise(wall(2.f), {}, 5);
  DepthEstimateConfig off;
  off.enabled = false;
  const DepthEstimate found = estimate(depth, off);
  EXPECT_EQ(found.depth_m, depth);
  EXPECT_TRUE(found.sigma_m.empty());
}

TEST(DepthEstimate, GivesTheSameBitsForEveryThreadCount) {
  const DepthImage depth = with_noise(corner(4.f), {}, 6);
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return estimate(depth);
  };
  const DepthEstimate one = with_threads(1), two = with_threads(2);
  EXPECT_EQ(one.depth_m, two.depth_m);
  EXPECT_EQ(one.sigma_m, two.sigma_m);
}

}  // namespace
}  // namespace ovimap
