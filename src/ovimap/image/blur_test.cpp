// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/image/blur.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

constexpr int kWidth = 160, kHeight = 120, kFiner = 2;

/// Brightness of a scene at a place in pixels.
using Scene = std::function<double(double x, double y)>;

/// Boxes of any size and brightness, one over another.
Scene boxes(unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  struct Box {
    double left, top, right, bottom, level;
  };
  std::vector<Box> drawn;
  for (int i = 0; i < 40; ++i) {
    const double x = draw(0, kWidth), y = draw(0, kHeight);
    drawn.push_back({x, y, x + draw(12, 60), y + draw(12, 60), draw(30, 220)});
  }
  return [drawn](double x, double y) {
    double level = 90;
    for (const Box& box : drawn)
      if (x >= box.left && x < box.right && y >= box.top && y < box.bottom) level = box.level;
    return level;
  };
}

/// Shaded balls before a wall that darkens to one side: few edges, much shading.
Scene balls() {
  return [](double x, double y) {
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) {
        const double dx = x - 20 - 40 * column, dy = y - 20 - 40 * row;
        const double reach = 1 - (dx * dx + dy * dy) / (15. * 15.);
        if (reach > 0) return 40 + 10. * column + 130 * std::sqrt(reach);
      }
    return 120 - 0.4 * x;
  };
}

/// Slanted stripes of three widths, as of cloth and print.
Scene stripes() {
  return [](double x, double y) {
    const double along = x + 0.5 * y, width = y < 40 ? 12 : y < 80 ? 18 : 26;
    return std::fmod(along, 2 * width) < width ? 200.0 : 60.0;
  };
}

/// As a camera sees it that moved by (x, y) pixels meanwhile, with noise of two levels.
RgbImage picture(const Scene& scene, double x_px, double y_px, double noise = 2) {
  std::mt19937 random(7);
  std::normal_distribution<double> grain(0, noise);
  const int steps = 1 + 2 * static_cast<int>(std::ceil(std::hypot(x_px, y_px)));
  RgbImage image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      double sum = 0;
      for (int step = 0; step < steps; ++step)
        for (int sub = 0; sub < kFiner * kFiner; ++sub) {
          const double moved = steps == 1 ? 0 : step / (steps - 1.0) - 0.5;
          sum += scene(x + (sub % kFiner + 0.5) / kFiner + moved * x_px,
                       y + (sub / kFiner + 0.5) / kFiner + moved * y_px);
        }
      const double level = sum / (steps * kFiner * kFiner);
      const auto byte = [&] {
        return static_cast<std::uint8_t>(
            std::clamp(level + (noise > 0 ? grain(random) : 0.0), 0.0, 255.0));
      };
      image.at(x, y) = {byte(), byte(), byte()};
    }
  return image;
}

TEST(Blur, IsTheWayThatTheCameraMovedWhateverItSees) {
  for (const Scene& scene : {boxes(1), boxes(2), stripes()})
    for (const int moved_px : {2, 4, 8}) {
      EXPECT_NEAR(measure_blur(picture(scene, moved_px, 0)).across.px, moved_px + 0.6f, 0.3f);
      EXPECT_GT(measure_blur(picture(scene, 0, moved_px)).down.px, 0.85f * moved_px);
    }
  for (const Scene& scene : {boxes(1), boxes(2), stripes()}) {
    EXPECT_LT(measure_blur(picture(scene, 0, 0)).across.px, 1.6f);
    EXPECT_LT(measure_blur(picture(scene, 0, 0)).down.px, 2.2f) << "stripes lean: 2 along columns";
  }
}

TEST(Blur, LeavesEdgesSharpAlongTheMotion) {
  const Blur sharp = measure_blur(picture(boxes(1), 0, 0));
  const Blur smeared = measure_blur(picture(boxes(1), 8, 0));
  EXPECT_NEAR(smeared.down.px, sharp.down.px, 0.2f);
  const Blur aslant = measure_blur(picture(boxes(1), 6, 6));
  EXPECT_NEAR(aslant.across.px, 6.6f, 0.5f);
  EXPECT_NEAR(aslant.down.px, 6.6f, 0.5f);
}

TEST(Blur, RanksPicturesThatShowNothingSharp) {
  float before = 0;
  for (const int moved_px : {0, 2, 4, 8}) {
    const Blur blur = measure_blur(picture(balls(), moved_px, 0));
    EXPECT_GT(blur.across.px, before);
    before = blur.across.px;
  }
}

TEST(Blur, IsNotFooledByNoiseOrContrast) {
  const auto flat = [](double, double) { return 100.0; };
  EXPECT_EQ(measure_blur(picture(flat, 0, 0)).across.edges, 0) << "noise alone has no edges";
  const auto faint = [scene = boxes(1)](double x, double y) { return 90 + scene(x, y) / 3; };
  EXPECT_NEAR(measure_blur(picture(faint, 8, 0)).across.px, 8, 1.5f);
  EXPECT_NEAR(measure_blur(picture(boxes(1), 8, 0, 0)).across.px, 8.6f, 0.3f);
}

TEST(Blur, EveryFourthLineIsEnough) {
  const RgbImage image = picture(boxes(2), 4, 0);
  EXPECT_NEAR(measure_blur(image, 4).across.px, measure_blur(image).across.px, 0.5f);
}

TEST(Blur, OfNoPictureIsNotKnown) {
  for (const RgbImage& image : {RgbImage(), RgbImage(1, 1), RgbImage(30, 20, {200, 9, 9})}) {
    EXPECT_EQ(measure_blur(image).across.edges, 0);
    EXPECT_EQ(measure_blur(image).down.px, 1.f);
  }
}

}  // namespace
}  // namespace ovimap
