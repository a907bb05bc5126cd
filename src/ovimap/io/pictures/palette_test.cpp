// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/pictures/palette.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Core>

namespace ovimap {
namespace {

double decoded(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

/// OKLab coordinates (lightness in [0, 1], a, b) of an sRGB colour, after B. Ottosson, "A
/// perceptual color space for image processing" (2020).
Eigen::Vector3d oklab_of(Rgb8 color) {
  const Eigen::Vector3d rgb(decoded(color.r / 255.0), decoded(color.g / 255.0),
                            decoded(color.b / 255.0));
  const Eigen::Matrix3d cone_from_rgb{{0.4122214708, 0.5363325363, 0.0514459929},
                                      {0.2119034982, 0.6806995451, 0.1073969566},
                                      {0.0883024619, 0.2817188376, 0.6299787005}};
  const Eigen::Matrix3d lab_from_cone{{0.2104542553, 0.7936177850, -0.0040720468},
                                      {1.9779984951, -2.4285922050, 0.4505937099},
                                      {0.0259040371, 0.7827717662, -0.8086757660}};
  const Eigen::Vector3d cone = cone_from_rgb * rgb;
  return lab_from_cone *
         Eigen::Vector3d(std::cbrt(cone.x()), std::cbrt(cone.y()), std::cbrt(cone.z()));
}

TEST(Palette, OklabAgreesWithPublishedValues) {
  EXPECT_NEAR((oklab_of({255, 255, 255}) - Eigen::Vector3d(1, 0, 0)).norm(), 0, 1e-4);
  EXPECT_NEAR((oklab_of({0, 0, 0})).norm(), 0, 1e-6);
  EXPECT_NEAR((oklab_of({255, 0, 0}) - Eigen::Vector3d(0.62796, 0.22486, 0.12585)).norm(), 0, 1e-4);
}

TEST(Palette, TheFirstFortyAreFarApart) {
  constexpr double kApart = 0.055;
  for (std::uint32_t a = 0; a <= 40; ++a)
    for (std::uint32_t b = a + 1; b <= 40; ++b)
      EXPECT_GE((oklab_of(instance_color(a)) - oklab_of(instance_color(b))).norm(), kApart)
          << a << " and " << b;
}

TEST(Palette, StaysReadableForAnyId) {
  for (const std::uint32_t id : {1u, 77u, 65535u, 1000003u, 4294967295u}) {
    const Eigen::Vector3d lab = oklab_of(instance_color(id));
    EXPECT_GT(lab.x(), 0.44) << id;
    EXPECT_LT(lab.x(), 0.89) << id;
    EXPECT_GT(lab.tail<2>().norm(), 0.02) << id;  // not taken for the grey of no instance
  }
}

TEST(Palette, ColoursAVertexLikeItsId) {
  const std::vector<std::uint32_t> ids = {3, 0, 3, 70000};
  const auto colors = instance_colors(ids);
  ASSERT_EQ(colors.size(), ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const Rgb8 color = instance_color(ids[i]);
    EXPECT_EQ(colors[i], (std::array<std::uint8_t, 3>{color.r, color.g, color.b}));
  }
}

TEST(HeatColor, GetsLighterAllTheWay) {
  double before = -1;
  for (int i = 0; i <= 100; ++i) {
    const double lightness = oklab_of(heat_color(static_cast<float>(i) / 100.f))[0];
    EXPECT_GT(lightness, before - 1e-3) << i;
    before = lightness;
  }
  EXPECT_EQ(heat_color(-1.f), heat_color(0.f));
  EXPECT_EQ(heat_color(2.f), heat_color(1.f));
}

}  // namespace
}  // namespace ovimap
