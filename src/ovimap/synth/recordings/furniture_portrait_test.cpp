// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/recordings/furniture_portrait.h"

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"
#include "ovimap/synth/shapes/mesh_parts.h"

namespace ovimap {
namespace {

/// A cube that shines pure red: what of it is seen is known by its colour.
TexturedMesh red_cube(float side_m) {
  TexturedMesh mesh;
  SurfaceMaterial red;
  red.albedo = {1, 0, 0};
  red.emission.setConstant(5);
  const float half = side_m / 2;
  add_box(mesh, {-half, -half, 0}, {half, half, side_m}, add_material(mesh, red));
  return mesh;
}

PortraitConfig quick() {
  PortraitConfig config;
  config.views = 4;
  config.views_per_room = 2;
  config.patterns = 2;
  config.least_side_px = 48;
  config.largest_side_px = 64;
  config.least_visible_px = 100;
  return config;
}

FurnitureEntry standing_at(float elevation_m, bool door_or_window = false) {
  FurnitureEntry entry;
  entry.elevation_m = elevation_m;
  entry.door_or_window = door_or_window;
  return entry;
}

bool red(const Rgb8& pixel) {
  return pixel.r > 200 && pixel.g < 60 && pixel.b < 60;
}

/// Every pixel that the mask gives to the cube is red, but for smoothed edges, and no other is.
void expect_mask_is_the_cube(const Portrait& portrait) {
  ASSERT_EQ(portrait.color.width(), portrait.visible.width());
  ASSERT_EQ(portrait.color.height(), portrait.visible.height());
  int visible = 0, agreeing = 0;
  for (int y = 0; y < portrait.color.height(); ++y)
    for (int x = 0; x < portrait.color.width(); ++x) {
      const bool seen = portrait.visible.at(x, y) == 255;
      visible += seen;
      agreeing += seen == red(portrait.color.at(x, y));
    }
  const int pixels = portrait.color.width() * portrait.color.height();
  EXPECT_GE(visible, quick().least_visible_px);
  EXPECT_LT(visible, pixels);
  EXPECT_GT(agreeing, pixels * 85 / 100);
}

TEST(PortraitStudioTest, ObjectsAreShownWhereverTheyBelong) {
  const PortraitStudio studio(3, quick());
  for (const auto& entry :
       {standing_at(0), standing_at(1.2f), standing_at(2.3f), standing_at(0, true)})
    for (const float side_m : {0.1f, 0.9f}) {
      const auto portraits = studio.draw(entry, red_cube(side_m), 5);
      ASSERT_FALSE(portraits.empty()) << entry.elevation_m << " " << side_m;
      for (const Portrait& portrait : portraits) expect_mask_is_the_cube(portrait);
    }
}

TEST(PortraitStudioTest, PicturesDependOnSeedAndNumberAlone) {
  const auto draw = [](std::uint64_t seed, std::uint64_t number, int threads) {
    const ThreadLimit limit(threads);
    return PortraitStudio(seed, quick()).draw(standing_at(0), red_cube(0.8f), number);
  };
  const auto first = draw(1, 2, 1), again = draw(1, 2, 2);
  ASSERT_EQ(first.size(), again.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].color, again[i].color);
    EXPECT_EQ(first[i].visible, again[i].visible);
  }
  EXPECT_NE(first[0].color, draw(2, 2, 1)[0].color);
  EXPECT_NE(first[0].color, draw(1, 3, 1)[0].color);
}

TEST(PortraitStudioTest, WhatFitsNoRoomIsLeftOut) {
  const PortraitStudio studio(1, quick());
  EXPECT_TRUE(studio.draw(standing_at(0), red_cube(6), 0).empty());
  EXPECT_TRUE(studio.draw(standing_at(0), TexturedMesh{}, 0).empty());
}

}  // namespace
}  // namespace ovimap
