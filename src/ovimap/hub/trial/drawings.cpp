// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/trial/drawings.h"

#include <cmath>
#include <cstdlib>
#include <functional>

namespace ovimap {

namespace {

constexpr int kSidePx = 256;
constexpr Rgb8 kBlack = {0, 0, 0}, kWhite = {255, 255, 255}, kGrey = {128, 128, 128},
               kRed = {230, 20, 20};

/// `inside` takes coordinates from -1 to 1, x to the right, y down.
RgbImage shape(const std::function<bool(float x, float y)>& inside) {
  RgbImage picture(kSidePx, kSidePx, kWhite);
  for (int y = 0; y < kSidePx; ++y)
    for (int x = 0; x < kSidePx; ++x) {
      const auto centred = [](int at) {
        return (2.f * static_cast<float>(at) + 1.f) / static_cast<float>(kSidePx) - 1.f;
      };
      if (inside(centred(x), centred(y))) picture.at(x, y) = kBlack;
    }
  return picture;
}

}  // namespace

std::vector<Drawing> drawn_colours() {
  const std::vector<std::pair<const char*, Rgb8>> colours = {{"red", kRed},
                                                             {"green", {20, 160, 40}},
                                                             {"blue", {20, 50, 220}},
                                                             {"yellow", {250, 220, 20}},
                                                             {"orange", {250, 130, 10}},
                                                             {"purple", {130, 20, 150}},
                                                             {"black", kBlack},
                                                             {"white", kWhite}};
  std::vector<Drawing> drawings;
  for (const auto& [name, colour] : colours)
    drawings.push_back({name, RgbImage(kSidePx, kSidePx, colour)});
  return drawings;
}

std::vector<Drawing> drawn_shapes() {
  constexpr float kHalf = 0.6f, kArm = 0.15f;
  return {{"circle", shape([](float x, float y) { return x * x + y * y < kHalf * kHalf; })},
          {"square",
           shape([](float x, float y) { return std::abs(x) < kHalf && std::abs(y) < kHalf; })},
          {"triangle", shape([](float x, float y) {
             return y > -kHalf && y < kHalf && std::abs(x) < (y + kHalf) / 2;
           })},
          {"cross", shape([](float x, float y) {
             return (std::abs(x) < kArm && std::abs(y) < kHalf) ||
                    (std::abs(y) < kArm && std::abs(x) < kHalf);
           })}};
}

RgbImage drawn_disc(int width_px, int height_px, int radius_px) {
  RgbImage picture(width_px, height_px, kGrey);
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x)
      if (std::hypot(x - width_px / 2, y - height_px / 2) < radius_px) picture.at(x, y) = kRed;
  return picture;
}

}  // namespace ovimap
