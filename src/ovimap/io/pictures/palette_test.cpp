// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/pictures/palette.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

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
