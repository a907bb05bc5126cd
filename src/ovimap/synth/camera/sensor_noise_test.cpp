// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/camera/sensor_noise.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

RenderedView flat_wall(float depth_m, float incidence_cos = 1) {
  RenderedView view;
  view.depth = DepthImage(160, 120, depth_m);
  view.ids = IdImage(160, 120, 1);
  view.incidence_cos = Image<float>(160, 120, incidence_cos);
  return view;
}

struct Spread {
  double mean = 0, sigma = 0, lost = 0;
};
Spread spread_of(const DepthImage& depth) {
  double sum = 0, squares = 0, valid = 0;
  for (const float value : depth)
    if (value > 0) sum += value, squares += value * value, ++valid;
  const double mean = sum / valid;
  return {mean, std::sqrt(squares / valid - mean * mean),
          1 - valid / static_cast<double>(depth.size())};
}

TEST(SensorNoise, SpreadGrowsAsTheModelSays) {
  SensorNoiseConfig config;
  config.disparity_step_px = 1e-4f;
  for (const float depth : {0.8f, 2.f, 4.f}) {
    const Spread spread = spread_of(noisy_depth(flat_wall(depth), config, 3));
    const double expected = 0.0012 + 0.0019 * (depth - 0.4) * (depth - 0.4);
    EXPECT_NEAR(spread.mean, depth, expected * 0.05) << depth;
    EXPECT_NEAR(spread.sigma, expected, expected * 0.05) << depth;
    EXPECT_NEAR(spread.lost, 0.001, 0.001) << depth;
  }
}

TEST(SensorNoise, AnswersComeInStepsOfDisparity) {
  std::set<float> values;
  for (const float value : noisy_depth(flat_wall(3), {}, 3))
    if (value > 0) values.insert(value);
  EXPECT_LT(values.size(), 12u);
  for (const float value : values) {
    const double steps = 43.5 / value / 0.125;
    EXPECT_NEAR(steps, std::round(steps), 1e-3);
  }
}

/// Of the errors of pixels `apart` columns from each other; 1: the same.
double correlation(const DepthImage& depth, double truth, int apart) {
  double both = 0, one = 0;
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x + apart < depth.width(); ++x) {
      const double a = depth.at(x, y) - truth, b = depth.at(x + apart, y) - truth;
      if (depth.at(x, y) <= 0 || depth.at(x + apart, y) <= 0) continue;
      both += a * b, one += a * a;
    }
  return both / one;
}

TEST(SensorNoise, MatchedOverWindowsNeighboursErrAlike) {
  SensorNoiseConfig config;
  config.disparity_step_px = 1e-4f;
  EXPECT_NEAR(correlation(noisy_depth(flat_wall(3), config, 3), 3, 1), 0, 0.05);
  config.correlation_px = 6;
  const DepthImage depth = noisy_depth(flat_wall(3), config, 3);
  EXPECT_GT(correlation(depth, 3, 1), 0.8);
  EXPECT_NEAR(correlation(depth, 3, 20), 0, 0.15);
  const Spread spread = spread_of(depth);  // of the same size as before
  EXPECT_NEAR(spread.sigma, 0.0012 + 0.0019 * 2.6 * 2.6, 0.001);
  EXPECT_NE(noisy_depth(flat_wall(3), config, 4), depth);
}

TEST(SensorNoise, ALensErrsAlikeInEveryFrame) {
  SensorNoiseConfig config;
  config.disparity_step_px = 1e-4f;
  config.sigma_base_m = config.sigma_growth_per_m = config.random_loss = 0;
  config.lens_bias_px = 0.1f;
  const DepthImage depth = noisy_depth(flat_wall(3), config, 3);
  EXPECT_EQ(noisy_depth(flat_wall(3), config, 4), depth);
  EXPECT_GT(spread_of(depth).sigma, 0.005);
  EXPECT_LT(spread_of(depth).sigma, 0.05);
  EXPECT_GT(correlation(depth, 3, 5), 0.9);
}

TEST(SensorNoise, GrazingAndFarSurfacesGiveNoAnswer) {
  EXPECT_EQ(spread_of(noisy_depth(flat_wall(2, 0.05f), {}, 1)).lost, 1);
  const SensorNoiseConfig config;
  const float halfway = (config.grazing_start_cos + config.grazing_end_cos) / 2;
  EXPECT_NEAR(spread_of(noisy_depth(flat_wall(2, halfway), config, 1)).lost, 0.5, 0.03);
  EXPECT_EQ(spread_of(noisy_depth(flat_wall(6.5f), config, 1)).lost, 1);
  EXPECT_EQ(spread_of(noisy_depth(flat_wall(0), config, 1)).lost, 1);
}

TEST(SensorNoise, DepthEdgesHaveHoles) {
  RenderedView view = flat_wall(2);
  for (int y = 0; y < 120; ++y)
    for (int x = 80; x < 160; ++x) view.depth.at(x, y) = 3;
  SensorNoiseConfig config;
  config.lateral_sigma_px = 0;
  const DepthImage noisy = noisy_depth(view, config, 9);
  int edge_lost = 0, other_lost = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x)
      if (noisy.at(x, y) == 0) ++(x == 79 || x == 80 ? edge_lost : other_lost);
  EXPECT_NEAR(edge_lost / 240., config.edge_loss, 0.12);
  EXPECT_LT(other_lost, 60);
}

TEST(SensorNoise, SameSeedSameBytes) {
  const RenderedView view = flat_wall(2);
  EXPECT_EQ(noisy_depth(view, {}, 4), noisy_depth(view, {}, 4));
  EXPECT_NE(noisy_depth(view, {}, 4), noisy_depth(view, {}, 5));
  const RgbImage grey(40, 30, {100, 100, 100});
  EXPECT_EQ(noisy_color(grey, {}, 4), noisy_color(grey, {}, 4));
  EXPECT_NE(noisy_color(grey, {}, 4), grey);
}

TEST(SensorNoise, PosesMoveOnlyWhenAsked) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(1, 2, 3);
  EXPECT_TRUE(noisy_pose(pose, {}, 1).isApprox(pose, 0));
  SensorNoiseConfig config;
  config.position_sigma_m = 0.01f;
  config.rotation_sigma_rad = 0.01f;
  const Pose moved = noisy_pose(pose, config, 1);
  EXPECT_TRUE(pose_fault(moved.matrix()).empty());
  EXPECT_GT((moved.translation() - pose.translation()).norm(), 1e-4);
  EXPECT_LT((moved.translation() - pose.translation()).norm(), 0.08);
}

}  // namespace
}  // namespace ovimap
