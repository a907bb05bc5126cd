// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/colors.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

/// A plain patch on a grey ground, of that much light.
StoredCrop patch(Rgb8 color, float red_light = 1.f, float blue_light = 1.f) {
  ObjectCrop crop;
  crop.image = RgbImage(32, 32);
  crop.mask = Image<std::uint8_t>(32, 32);
  const auto lit = [](std::uint8_t value, float light) {
    return static_cast<std::uint8_t>(std::min(255.f, light * static_cast<float>(value)));
  };
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const bool on = x > 4 && x < 27 && y > 4 && y < 27;
      const Rgb8 shown = on ? color : Rgb8{128, 128, 128};
      crop.image.at(x, y) = {lit(shown.r, red_light), shown.g, lit(shown.b, blue_light)};
      crop.mask.at(x, y) = on ? 1 : 0;
    }
  crop.object_px = {Eigen::Vector2i(5, 5), Eigen::Vector2i(26, 26)};
  CropConfig config;
  config.kept_quality = 100;
  return store_crop(crop, config);
}

std::string main_color(const SurfaceColors& surface) {
  const ColorShares& shares = surface.shares;
  const auto best = std::max_element(shares.begin(), shares.end());
  return *best > 0.f ? color_name(static_cast<Color>(best - shares.begin())) : "";
}

const std::vector<std::pair<const char*, Rgb8>> kPatches{
    {"red", {190, 30, 40}},     {"green", {40, 140, 60}},   {"blue", {40, 80, 180}},
    {"yellow", {235, 205, 50}}, {"white", {240, 240, 240}}, {"black", {20, 20, 20}},
    {"grey", {130, 130, 130}},  {"brown", {105, 65, 40}},   {"orange", {235, 125, 35}}};

TEST(ObjectColors, NamesPlainColors) {
  const ObjectColors colors([] {
    std::vector<StoredCrop> crops;
    for (const auto& [name, color] : kPatches) crops.push_back(patch(color));
    crops.emplace_back();  // an object without a crop
    return crops;
  });
  for (std::size_t i = 0; i < kPatches.size(); ++i)
    EXPECT_EQ(main_color(colors.surfaces()[i]), kPatches[i].first);
  EXPECT_EQ(main_color(colors.surfaces().back()), "");
}

TEST(ObjectColors, ADamagedPictureCostsItsOwnObjectAlone) {
  const ObjectColors colors([] {
    std::vector<StoredCrop> crops;
    for (const auto& [name, color] : kPatches) crops.push_back(patch(color));
    crops.push_back(crops[0]);
    crops.back().image_jpeg = {1, 2, 3};
    return crops;
  });
  for (std::size_t i = 0; i < kPatches.size(); ++i)
    EXPECT_EQ(main_color(colors.surfaces()[i]), kPatches[i].first);
  EXPECT_EQ(main_color(colors.surfaces().back()), "");
}

TEST(ObjectColors, TakesWarmLightOut) {
  const auto crops = [](float red, float blue) {
    std::vector<StoredCrop> all;
    for (const auto& [name, color] : kPatches) all.push_back(patch(color, red, blue));
    return all;
  };
  const ObjectColors colors([&] { return crops(1.f, 0.8f); });
  EXPECT_EQ(main_color(colors.surfaces()[4]), "white");
  EXPECT_EQ(main_color(colors.surfaces()[6]), "grey");
  EXPECT_EQ(main_color(colors.surfaces()[2]), "blue");
}

TEST(ObjectColors, KnowsShadesOfAColor) {
  const std::vector<std::pair<Color, Rgb8>> dark{{Color::kBlue, {25, 40, 100}},
                                                 {Color::kGreen, {25, 75, 35}},
                                                 {Color::kRed, {120, 20, 28}},
                                                 {Color::kGrey, {90, 90, 92}}};
  const std::vector<std::pair<Color, Rgb8>> light{{Color::kBlue, {120, 180, 235}},
                                                  {Color::kGreen, {140, 200, 110}},
                                                  {Color::kPurple, {165, 120, 215}},
                                                  {Color::kGrey, {185, 185, 187}}};
  const ObjectColors colors([&] {
    std::vector<StoredCrop> crops;
    for (const auto& [color, shown] : dark) crops.push_back(patch(shown));
    for (const auto& [color, shown] : light) crops.push_back(patch(shown));
    crops.push_back(patch({60, 115, 215}));   // neither
    crops.push_back(patch({250, 250, 250}));  // what the light is told by
    return crops;
  });
  const auto rated = [&](std::size_t i, Color color, Shade shade) {
    return shade_rating(color, colors.surfaces()[i].lightness[static_cast<std::size_t>(color)],
                        shade);
  };
  for (std::size_t i = 0; i < dark.size(); ++i) {
    EXPECT_GT(rated(i, dark[i].first, Shade::kDark), 0.5f) << i;
    EXPECT_LT(rated(i, dark[i].first, Shade::kLight), 0.2f) << i;
  }
  for (std::size_t i = 0; i < light.size(); ++i) {
    EXPECT_GT(rated(dark.size() + i, light[i].first, Shade::kLight), 0.5f) << i;
    EXPECT_LT(rated(dark.size() + i, light[i].first, Shade::kDark), 0.2f) << i;
  }
  EXPECT_LT(rated(8, Color::kBlue, Shade::kDark), 0.5f);
  EXPECT_LT(rated(8, Color::kBlue, Shade::kLight), 0.5f);
}

TEST(ShadeOfWord, KnowsSynonyms) {
  EXPECT_EQ(shade_of_word("deep"), Shade::kDark);
  EXPECT_EQ(shade_of_word("pale"), Shade::kLight);
  EXPECT_FALSE(shade_of_word("bright"));
  for (const Shade shade : {Shade::kDark, Shade::kLight})
    EXPECT_EQ(shade_of_word(shade_name(shade)), shade);
}

TEST(Oklab, HasLightnessOneForWhiteAndNoHueForGrey) {
  const Eigen::Vector3f white = oklab({1.f, 1.f, 1.f}), grey = oklab({0.2f, 0.2f, 0.2f});
  EXPECT_NEAR(white.x(), 1.f, 1e-3f);
  EXPECT_NEAR(grey.tail<2>().norm(), 0.f, 1e-3f);
}

TEST(ColorOfWord, KnowsSynonyms) {
  EXPECT_EQ(color_of_word("gray"), Color::kGrey);
  EXPECT_EQ(color_of_word("red"), Color::kRed);
  EXPECT_FALSE(color_of_word("wooden"));
  for (std::size_t i = 0; i < kColorCount; ++i)
    EXPECT_EQ(color_of_word(color_name(static_cast<Color>(i))), static_cast<Color>(i));
}

}  // namespace
}  // namespace ovimap
