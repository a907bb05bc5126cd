// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/calibration/calibration_edges.h"

#include <cmath>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

/// A box from column 20 to 39 and row 15 to 29, one metre before a wall; white on black in colour.
Frame box() {
  Frame frame;
  frame.depth_camera = frame.color_camera = {80, 60, 70, 70, 39.5f, 29.5f};
  frame.depth = DepthImage(80, 60, 2.f);
  frame.color = RgbImage(80, 60);
  for (int y = 15; y < 30; ++y)
    for (int x = 20; x < 40; ++x) {
      frame.depth.at(x, y) = 1.f;
      frame.color.at(x, y) = {255, 255, 255};
    }
  return frame;
}

TEST(CalibrationEdges, LieOnTheBorderOfTheNearerSurface) {
  const Frame frame = box();
  const CalibrationEdges edges = find_calibration_edges(frame, {});
  EXPECT_EQ(edges.depth.size(), 2u * (20 + 15));
  for (const DepthEdge& edge : edges.depth) {
    const Eigen::Vector2f pixel = frame.depth_camera.project(edge.x_in_depth);
    EXPECT_FLOAT_EQ(edge.x_in_depth.z(), 1);
    const bool beside = std::abs(pixel.x() - 19.5f) < 1e-3f || std::abs(pixel.x() - 39.5f) < 1e-3f;
    const bool above = std::abs(pixel.y() - 14.5f) < 1e-3f || std::abs(pixel.y() - 29.5f) < 1e-3f;
    EXPECT_TRUE(edge.side == EdgeSide::kBeside ? beside : above) << pixel.transpose();
    const Eigen::Vector2f moved = frame.depth_camera.project(edge.x_in_depth + edge.outwards);
    EXPECT_NEAR((moved - pixel).norm(), 1, 1e-3);
    EXPECT_GT((moved - Eigen::Vector2f(29.5f, 22)).norm(),
              (pixel - Eigen::Vector2f(29.5f, 22)).norm());
  }
}

TEST(CalibrationEdges, HolesBehindABorderAreShadows) {
  Frame frame = box();
  for (int y = 0; y < 60; ++y) frame.depth.at(40, y) = frame.depth.at(41, y) = 0;
  EXPECT_EQ(find_calibration_edges(frame, {}).depth.size(), 2u * (20 + 15));
  CalibrationEdgesConfig strict;
  strict.max_hole = 0;
  EXPECT_EQ(find_calibration_edges(frame, strict).depth.size(), 2u * 20 + 15);
}

TEST(CalibrationEdges, MixedPixelsAreNoSurface) {
  Frame frame = box();
  frame.depth.at(60, 40) = 1.5f;
  EXPECT_EQ(find_calibration_edges(frame, {}).depth.size(), 2u * (20 + 15));
}

TEST(CalibrationEdges, ThinnedToWhatIsAskedFor) {
  CalibrationEdgesConfig config;
  config.max_points = 30;
  EXPECT_EQ(find_calibration_edges(box(), config).depth.size(), 30u);
}

TEST(CalibrationEdges, DistancesAreThoseToTheNearestEdgeOfTheSide) {
  CalibrationEdgesConfig config;
  config.reach = 0.1f;  // 8 pixels
  const CalibrationEdges edges = find_calibration_edges(box(), config);
  const Image<std::uint8_t>& beside = edges.color_distance[0];
  const Image<std::uint8_t>& above = edges.color_distance[1];
  // Between the columns 19 and 20 an edge takes one of both.
  const int left = beside.at(19, 22) == 0 ? 19 : 20;
  EXPECT_EQ(beside.at(left, 22), 0);
  for (int apart = 1; apart < 7; ++apart) {
    EXPECT_EQ(beside.at(left - apart, 22), 8 * apart);
    EXPECT_EQ(beside.at(left + apart, 22), 8 * apart);
  }
  EXPECT_NEAR(above.at(30, 22), 8 * 7, 8) << "to the nearer of the two borders";
  EXPECT_EQ(beside.at(60, 50), 64) << "as far as distances are known";
  EXPECT_NEAR(beside.at(left - 3, 30 + 3), 8 * std::hypot(3, 4), 8 * 1.5) << "around the corner";
}

TEST(CalibrationEdges, WeakColourIsNoEdge) {
  Frame frame = box();
  for (Rgb8& pixel : frame.color) pixel = pixel.r > 0 ? Rgb8{12, 12, 12} : Rgb8{10, 10, 10};
  for (const auto& field : find_calibration_edges(frame, {}).color_distance)
    for (const std::uint8_t distance : field) EXPECT_EQ(distance, 32);
}

}  // namespace
}  // namespace ovimap
