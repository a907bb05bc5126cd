// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/shapes/surface_patterns.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ovimap/base/error.h"
#include "ovimap/synth/shapes/painting.h"
#include "ovimap/synth/shapes/random.h"

namespace ovimap {
namespace {

using Color = PaintColor;

SurfacePattern planks(const Color& light, const Color& dark, std::uint64_t seed) {
  constexpr int kRows = 16, kPlanksPerRow = 2;
  const LatticeNoise grain(seed), tone(seed + 1);
  return repeating([=](float x, float y) {
    const float row = std::floor(y * kRows), in_row = y * kRows - row;
    const float shift = tone.at(0.5f, row, 7, kRows);
    const float along = (x + shift) * kPlanksPerRow, plank = std::floor(along);
    const int index =
        static_cast<int>(plank) % kPlanksPerRow + kPlanksPerRow * static_cast<int>(row);
    const float plank_tone = tone.at(static_cast<float>(index) * 3 + 0.5f, 5.5f, 97, 31);
    const float fine = grain.at(x * 32, y * 512, 32, 512), broad = grain.at(x * 6, y * 96, 6, 96);
    const float share = 0.15f + 0.45f * plank_tone + 0.25f * broad + 0.15f * fine;
    const float gap = std::min({in_row, 1 - in_row, (along - plank) * 8, (plank + 1 - along) * 8});
    return Color(mixed(light, dark, share) * (0.55f + 0.45f * smooth_step(0.005f, 0.03f, gap)));
  });
}

SurfacePattern tiles(std::uint64_t seed) {
  constexpr int kTiles = 8;
  const LatticeNoise noise(seed);
  const Color stone(0.78f, 0.74f, 0.68f), joint(0.5f, 0.48f, 0.45f);
  return repeating([=](float x, float y) {
    const float u = x * kTiles - std::floor(x * kTiles), v = y * kTiles - std::floor(y * kTiles);
    const float tone = noise.at(std::floor(x * kTiles), std::floor(y * kTiles), kTiles, kTiles);
    const float cloud = noise.at(x * 40, y * 40, 40, 40);
    const Color surface = stone * (0.88f + 0.1f * tone + 0.08f * cloud);
    return mixed(joint, surface, smooth_step(0.008f, 0.02f, std::min({u, v, 1 - u, 1 - v})));
  });
}

SurfacePattern carpet(std::uint64_t seed) {
  const LatticeNoise noise(seed);
  const Color pile(0.55f, 0.54f, 0.56f);
  return repeating([=](float x, float y) {
    const float fine = noise.at(x * 512, y * 512, 512, 512),
                broad = noise.at(x * 24, y * 24, 24, 24);
    return Color(pile * (0.7f + 0.4f * fine + 0.12f * broad));
  });
}

constexpr std::array<std::array<float, 3>, 8> kPaints = {{{0.82f, 0.25f, 0.18f},
                                                          {0.95f, 0.77f, 0.25f},
                                                          {0.13f, 0.30f, 0.52f},
                                                          {0.20f, 0.50f, 0.42f},
                                                          {0.93f, 0.90f, 0.82f},
                                                          {0.15f, 0.14f, 0.18f},
                                                          {0.55f, 0.35f, 0.55f},
                                                          {0.85f, 0.52f, 0.30f}}};

Color paint(Random& random) {
  const auto& chosen = kPaints[random.index(kPaints.size())];
  return {chosen[0], chosen[1], chosen[2]};
}

/// Short blocks laid in a herringbone.
SurfacePattern parquet(std::uint64_t seed) {
  constexpr float kCells = 32, kLength = 4;  // of a block's width
  const LatticeNoise tone(seed), grain(seed + 1);
  const Color light(0.72f, 0.52f, 0.34f), dark(0.50f, 0.33f, 0.20f);
  return repeating([=](float x, float y) {
    const float u = x * kCells, v = y * kCells, row = std::floor(v), column = std::floor(u);
    // Each cell belongs to a block that runs along u or along v, by its place on the diagonal.
    const float place = part_of((column - row) / (2 * kLength)) * 2 * kLength;
    const bool along_u = place < kLength;
    const float start = along_u ? column - place : row - (2 * kLength - 1 - place);
    const float id =
        tone.at((along_u ? start : column) + 0.5f, (along_u ? row : start) + 0.5f, 32, 32);
    const float across = along_u ? v - row : u - column, length = (along_u ? u : v) - start;
    const float fine = grain.at(along_u ? x * 40 : x * 400, along_u ? y * 400 : y * 40, 400, 400);
    const float gap = std::min({across, 1 - across, length, kLength - length});
    return Color(mixed(light, dark, 0.2f + 0.5f * id + 0.3f * fine) *
                 (0.6f + 0.4f * smooth_step(0.02f, 0.08f, gap)));
  });
}

SurfacePattern mosaic(std::uint64_t seed) {
  constexpr int kCells = 24;
  const LatticeNoise noise(seed);
  return repeating([=](float x, float y) {
    const float shift = 0.5f * part_of(std::floor(y * kCells) / 2) * 2;
    const float u = part_of(x * kCells + shift), v = part_of(y * kCells);
    const float tone = noise.at(std::floor(x * kCells + shift) + 0.5f,
                                std::floor(y * kCells) + 0.5f, kCells, kCells);
    const Color stone = mixed({0.62f, 0.66f, 0.66f}, {0.86f, 0.85f, 0.8f}, tone);
    return mixed({0.55f, 0.55f, 0.54f}, stone,
                 smooth_step(0.02f, 0.07f, std::min({u, v, 1 - u, 1 - v})));
  });
}

}  // namespace

SurfacePattern floor_pattern(const std::string& style, std::uint64_t seed) {
  if (style == "oak") return planks({0.80f, 0.63f, 0.43f}, {0.55f, 0.38f, 0.22f}, seed);
  if (style == "walnut") return planks({0.52f, 0.36f, 0.25f}, {0.27f, 0.17f, 0.11f}, seed);
  if (style == "pine") return planks({0.90f, 0.78f, 0.58f}, {0.74f, 0.56f, 0.35f}, seed);
  if (style == "tiles") return tiles(seed);
  if (style == "carpet") return carpet(seed);
  if (style == "ash") return planks({0.82f, 0.77f, 0.70f}, {0.66f, 0.60f, 0.53f}, seed);
  if (style == "parquet") return parquet(seed);
  if (style == "mosaic") return mosaic(seed);
  throw Error(concat("floor style '", style,
                     "': not one of oak, walnut, pine, tiles, carpet, ash, parquet, mosaic"));
}

SurfacePattern wall_pattern(const std::string& style, Rgb8 color, std::uint64_t seed) {
  const Color base = Color(color.r, color.g, color.b) / 255;
  const LatticeNoise noise(seed);
  const auto plaster = [=](float x, float y) {
    return 0.95f + 0.03f * noise.at(x * 10, y * 10, 10, 10) +
           0.04f * noise.at(x * 256, y * 256, 256, 256);
  };
  if (style == "plaster")
    return repeating([=](float x, float y) { return Color(base * plaster(x, y)); });
  if (style == "stripes")
    return repeating([=](float x, float y) {
      const float wave = x * 16 - std::floor(x * 16);
      const float stripe = smooth_step(0.48f, 0.52f, wave) - smooth_step(0.96f, 1.f, wave);
      return Color(base * (plaster(x, y) * (1 - 0.13f * stripe)));
    });
  if (style == "dots")
    return repeating([=](float x, float y) {
      const float row = std::floor(y * 20), shift = 0.5f * (row - 2 * std::floor(row / 2));
      const float u = x * 20 + shift - std::floor(x * 20 + shift) - 0.5f, v = y * 20 - row - 0.5f;
      const float dot = 1 - smooth_step(0.2f, 0.26f, std::sqrt(u * u + v * v));
      return Color(base * (plaster(x, y) * (1 - 0.2f * dot)));
    });
  if (style == "roller")
    return repeating([=](float x, float y) {
      return Color(base * (0.96f + 0.05f * noise.at(x * 128, y * 96, 128, 96)));
    });
  if (style == "panels")
    return repeating([=](float x, float y) {
      const float u = part_of(x * 4), v = part_of(y * 2);
      const float edge = std::min(std::min(u, 1 - u) * 2, std::min(v, 1 - v) * 4);
      const float groove = smooth_step(0.16f, 0.19f, edge) - smooth_step(0.22f, 0.25f, edge);
      return Color(base * (plaster(x, y) * (1 - 0.12f * groove)));
    });
  throw Error(
      concat("wall style '", style, "': not one of plaster, stripes, dots, roller, panels"));
}

SurfacePattern rug_pattern(float width_m, float height_m, std::uint64_t seed) {
  Random random(seed);
  const Color ground = mixed(paint(random), {0.6f, 0.55f, 0.5f}, 0.4f), figure = paint(random),
              border = mixed(paint(random), {0.3f, 0.25f, 0.2f}, 0.5f);
  const LatticeNoise noise(seed);
  return picture(width_m, height_m, [=](float x, float y) {
    const float wool = 0.85f + 0.25f * noise.at(x * 400, y * 400, 400, 400);
    const float edge = std::min(std::min(x, 1 - x) * width_m, std::min(y, 1 - y) * height_m);
    if (edge < 0.12f) return Color((edge > 0.04f && edge < 0.08f ? figure : border) * wool);
    const float u = std::abs(x * width_m * 5 - std::floor(x * width_m * 5) - 0.5f);
    const float v = std::abs(y * height_m * 5 - std::floor(y * height_m * 5) - 0.5f);
    return Color((u + v < 0.33f ? figure : ground) * wool);
  });
}

SurfacePattern painting_pattern(float width_m, float height_m, std::uint64_t seed) {
  struct Stroke {
    float x, y, radius, stretch, angle;
    Color color;
  };
  Random random(seed);
  const Color low = paint(random), high = paint(random);
  std::vector<Stroke> strokes;
  for (int i = 0; i < 14; ++i)
    strokes.push_back({random.uniform(), random.uniform(), random.uniform(0.05f, 0.25f),
                       random.uniform(1, 4), random.uniform(0, 3.14f), paint(random)});
  const LatticeNoise noise(seed);
  return picture(width_m, height_m, [=](float x, float y) {
    Color color = mixed(high, low, smooth_step(0.2f, 0.8f, y));
    for (const Stroke& stroke : strokes) {
      const float dx = x - stroke.x, dy = y - stroke.y;
      const float u = dx * std::cos(stroke.angle) + dy * std::sin(stroke.angle);
      const float v = dy * std::cos(stroke.angle) - dx * std::sin(stroke.angle);
      const float distance = std::sqrt(u * u + v * v * stroke.stretch * stroke.stretch);
      color = mixed(color, stroke.color,
                    1 - smooth_step(stroke.radius * 0.94f, stroke.radius, distance));
    }
    return Color(color * (0.9f + 0.12f * noise.at(x * 90, y * 90, 90, 90)));
  });
}

SurfacePattern outdoor_pattern(float width_m, float height_m, std::uint64_t seed) {
  const LatticeNoise noise(seed);
  return picture(width_m, height_m, [=](float x, float y) {
    const float cloud =
        noise.at(x * 4, y * 6, 64, 64) * 0.6f + noise.at(x * 9, y * 13, 64, 64) * 0.4f;
    const Color sky =
        mixed({0.62f, 0.78f, 0.95f}, {0.97f, 0.97f, 0.97f}, smooth_step(0.4f, 0.75f, cloud));
    const float ridge = 0.55f + 0.15f * noise.at(x * 3, 0.5f, 64, 64);
    const float crown = 0.68f + 0.2f * noise.at(x * 7, 7.5f, 64, 64);
    const Color hill(0.55f, 0.68f, 0.62f);
    const Color tree =
        Color(0.22f, 0.42f, 0.18f) * (0.7f + 0.6f * noise.at(x * 14, y * 14, 64, 64));
    const Color far = mixed(sky, hill, smooth_step(ridge - 0.02f, ridge + 0.02f, y));
    return mixed(far, tree, smooth_step(crown - 0.02f, crown + 0.02f, y));
  });
}

}  // namespace ovimap
