// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/frame/rectification.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/base/parallel.h"

namespace ovimap {
namespace {

const PinholeCamera kCamera{320, 240, 250.f, 252.f, 158.3f, 121.7f};
const Lens kBarrel{Lens::Model::kBrownConrady, {-.28, .09, .001, -.0007, -.01}};
const Lens kRational{Lens::Model::kBrownConrady, {.4, -.3, .001, -.002, .05, .6, -.1, .02}};
const Lens kFisheye{Lens::Model::kKannalaBrandt, {.05, -.02, .006, -.001}};

constexpr double kSpacing_px = 40, kHalfLine_px = 3;  ///< of the drawn grid
constexpr double kFirst_px = 20;

/// The straight ray that a lens bends to `bent`: Newton's method with numeric derivatives.
Eigen::Vector2d straightened(const Lens& lens, const Eigen::Vector2d& bent) {
  Eigen::Vector2d ray = bent;
  for (int step = 0; step < 20; ++step) {
    constexpr double kStep = 1e-6;
    const Eigen::Vector2d at = lens.bend(ray);
    Eigen::Matrix2d slope;
    slope.col(0) = (lens.bend(ray + Eigen::Vector2d(kStep, 0)) - at) / kStep;
    slope.col(1) = (lens.bend(ray + Eigen::Vector2d(0, kStep)) - at) / kStep;
    ray -= slope.inverse() * (at - bent);
  }
  return ray;
}

/// Where a pixel of the lens's picture would be in a pinhole's.
Eigen::Vector2d straight_pixel(const Lens& lens, double u, double v) {
  const Eigen::Vector2d ray =
      straightened(lens, {(u - kCamera.cx) / kCamera.fx, (v - kCamera.cy) / kCamera.fy});
  return {ray.x() * kCamera.fx + kCamera.cx, ray.y() * kCamera.fy + kCamera.cy};
}

/// Dark lines on white, soft at their borders; how dark (0 to 1) the pinhole's picture is there.
double line_at(double pixel) {
  const double from = std::abs(std::remainder(pixel - kFirst_px, kSpacing_px));
  return std::max(0., 1 - from / kHalfLine_px);
}

/// The grid's picture through the lens: vertical lines in red, horizontal ones in green.
RgbImage bent_grid(const Lens& lens) {
  RgbImage image(kCamera.width, kCamera.height);
  const auto grey = [](double dark) { return static_cast<std::uint8_t>(255 - 240 * dark + 0.5); };
  for (int v = 0; v < kCamera.height; ++v)
    for (int u = 0; u < kCamera.width; ++u) {
      const Eigen::Vector2d at = straight_pixel(lens, u, v);
      image.at(u, v) = {grey(line_at(at.x())), grey(line_at(at.y())), 0};
    }
  return image;
}

/// The centre of the line near `expected` in a row of darkness.
template <class Dark>
double centre(double expected, Dark&& dark) {
  double sum = 0, moment = 0;
  const int middle = static_cast<int>(expected);
  for (int i = middle - 6; i <= middle + 6; ++i) sum += dark(i), moment += i * dark(i);
  return moment / sum;
}

double worst_line_px(const RgbImage& image) {
  double worst = 0;
  for (double line = kFirst_px; line < kCamera.width - 10; line += kSpacing_px)
    for (int v = 12; v < kCamera.height - 12; ++v)
      worst = std::max(
          worst, std::abs(line - centre(line, [&](int u) { return 255. - image.at(u, v).r; })));
  for (double line = kFirst_px; line < kCamera.height - 10; line += kSpacing_px)
    for (int u = 12; u < kCamera.width - 12; ++u)
      worst = std::max(
          worst, std::abs(line - centre(line, [&](int v) { return 255. - image.at(u, v).g; })));
  return worst;
}

class EachLens : public testing::TestWithParam<Lens> {};
INSTANTIATE_TEST_SUITE_P(Rectification, EachLens, testing::Values(kBarrel, kRational, kFisheye));

TEST_P(EachLens, MakesTheLinesOfAGridStraight) {
  const RgbImage bent = bent_grid(GetParam());
  EXPECT_GT(worst_line_px(bent), 1.5);
  EXPECT_LT(worst_line_px(Rectification(kCamera, GetParam(), "colour").color(bent)), 0.2);
}

TEST_P(EachLens, NeverMixesDepth) {
  DepthImage bent(kCamera.width, kCamera.height);
  std::set<float> stored = {0.f};
  for (int v = 0; v < kCamera.height; ++v)
    for (int u = 0; u < kCamera.width; ++u) {
      bent.at(u, v) = straight_pixel(GetParam(), u, v).x() < 100 ? 1.f : 3.f;
      stored.insert(bent.at(u, v));
    }
  const DepthImage straight = Rectification(kCamera, GetParam(), "depth").depth(bent);
  for (int v = 12; v < kCamera.height - 12; ++v)
    for (int u = 12; u < kCamera.width - 12; ++u) {
      ASSERT_TRUE(stored.contains(straight.at(u, v)));
      if (std::abs(u - 100) <= 1) continue;
      ASSERT_EQ(straight.at(u, v), u < 100 ? 1.f : 3.f) << u << " " << v;
    }
}

TEST(Rectification, HasNoDepthAndTheNearestColourBeyondTheLens) {
  const Lens pincushion{Lens::Model::kBrownConrady, {.5, 0, 0, 0, 0}};
  const Rectification rectification(kCamera, pincushion, "depth");
  EXPECT_EQ(rectification.depth(DepthImage(kCamera.width, kCamera.height, 2.f)).at(0, 0), 0.f);
  EXPECT_EQ(rectification.ids(IdImage(kCamera.width, kCamera.height, 7)).at(0, 0), 0);
  EXPECT_EQ(rectification.color(RgbImage(kCamera.width, kCamera.height, {9, 8, 7})).at(0, 0),
            (Rgb8{9, 8, 7}));
}

TEST(Rectification, ALensThatBendsNothingChangesNothing) {
  const Lens none{Lens::Model::kBrownConrady, {}};
  const RgbImage image = bent_grid(kBarrel);
  EXPECT_EQ(Rectification(kCamera, none, "colour").color(image), image);
}

TEST(Rectification, ThreadsDoNotChangeTheResult) {
  const RgbImage bent = bent_grid(kBarrel);
  const RgbImage many = Rectification(kCamera, kBarrel, "colour").color(bent);
  const ThreadLimit one(1);
  EXPECT_EQ(Rectification(kCamera, kBarrel, "colour").color(bent), many);
}

TEST(Rectification, RefusesCoefficientsThatCannotBeThisCameras) {
  for (const Lens& lens : {Lens{Lens::Model::kBrownConrady, {1e6, 0, 0, 0, 0}},
                           Lens{Lens::Model::kBrownConrady, {0, 0, 0, 0, 1e300}},
                           Lens{Lens::Model::kKannalaBrandt, {-1e9, 0, 0, 0}}})
    EXPECT_NE(error_of([&] {
                Rectification(kCamera, lens, "colour");
              }).find("the distortion of the colour camera shows only"),
              std::string::npos)
        << lens.coefficients[0];
}

TEST(Rectification, TakesNoMemoryForImagesThatNoCameraHas) {
  EXPECT_THROW(Rectification({32767, 32767, 500, 500, 1, 1}, kBarrel, "depth"), Error);
  EXPECT_THROW(Rectification({640, 1, 500, 500, 1, 1}, kBarrel, "depth"), Error);
}

TEST(RigRectification, TakesEachCameraByItself) {
  CameraRig rig;
  rig.color_camera = rig.depth_camera = kCamera;
  rig.color_lens = kBarrel;
  Frame frame;
  frame.color = bent_grid(kBarrel);
  frame.depth = DepthImage(kCamera.width, kCamera.height, 2.f);
  frame.depth.at(0, 0) = 1.f;
  const DepthImage depth = frame.depth;
  const RigRectification rectification(rig);
  rectification.apply(frame);
  EXPECT_LT(worst_line_px(frame.color), 0.2);
  EXPECT_EQ(frame.depth, depth);
  EXPECT_EQ(rectification.color_ids(IdImage(kCamera.width, kCamera.height, 3)).at(160, 120), 3);
}

}  // namespace
}  // namespace ovimap
