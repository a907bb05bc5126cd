// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/shapes/surface_patterns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"
#include "ovimap/synth/shapes/random.h"

namespace ovimap {
namespace {

constexpr std::size_t kRowsPerTask = 16;
constexpr int kRepeatSide_px = 1024;
constexpr float kRepeatSide_m = 2.56f;
constexpr float kPictureResolution_px_m = 400;

using Color = Eigen::Vector3f;  // sRGB 0..1: patterns are designed as seen, not as light

float smooth_step(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

Color mixed(const Color& a, const Color& b, float share_of_b) {
  return a + (b - a) * share_of_b;
}

/// Smooth random values in [0, 1] on a lattice that repeats after `period` cells.
class LatticeNoise {
 public:
  explicit LatticeNoise(std::uint64_t seed) : seed_(seed) {}

  float at(float x, float y, int period_x, int period_y) const {
    const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
    const float u = smooth_step(0, 1, x - static_cast<float>(left));
    const float v = smooth_step(0, 1, y - static_cast<float>(top));
    const auto corner = [&](int dx, int dy) {
      const auto wrap = [](int i, int period) { return ((i % period) + period) % period; };
      const auto cell = static_cast<std::uint64_t>(wrap(left + dx, period_x)) << 32 |
                        static_cast<std::uint64_t>(wrap(top + dy, period_y));
      return static_cast<float>(mix_bits(seed_ ^ mix_bits(cell)) >> 40) * 0x1p-24f;
    };
    const float upper = corner(0, 0) * (1 - u) + corner(1, 0) * u;
    const float lower = corner(0, 1) * (1 - u) + corner(1, 1) * u;
    return upper * (1 - v) + lower * v;
  }

 private:
  std::uint64_t seed_;
};

/// Paints each pixel from its place (x, y) in 0..1, y downwards.
std::shared_ptr<const Texture> painted(int width, int height,
                                       const std::function<Color(float, float)>& color_at) {
  RgbImage image(width, height);
  parallel_for(static_cast<std::size_t>(height), kRowsPerTask, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      const Color color = color_at((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                                   (static_cast<float>(y) + 0.5f) / static_cast<float>(height));
      const auto byte = [&](int i) {
        return static_cast<std::uint8_t>(std::clamp(color[i], 0.f, 1.f) * 255 + 0.5f);
      };
      image.at(x, y) = {byte(0), byte(1), byte(2)};
    }
  });
  return std::make_shared<Texture>(std::move(image));
}

SurfacePattern repeating(const std::function<Color(float, float)>& color_at) {
  return {painted(kRepeatSide_px, kRepeatSide_px, color_at), kRepeatSide_m, kRepeatSide_m};
}

SurfacePattern picture(float width_m, float height_m,
                       const std::function<Color(float, float)>& color_at) {
  const auto pixels = [](float metres) {
    return std::max(8, static_cast<int>(metres * kPictureResolution_px_m));
  };
  return {painted(pixels(width_m), pixels(height_m), color_at), width_m, height_m};
}

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

}  // namespace

SurfacePattern floor_pattern(const std::string& style, std::uint64_t seed) {
  if (style == "oak") return planks({0.80f, 0.63f, 0.43f}, {0.55f, 0.38f, 0.22f}, seed);
  if (style == "walnut") return planks({0.52f, 0.36f, 0.25f}, {0.27f, 0.17f, 0.11f}, seed);
  if (style == "pine") return planks({0.90f, 0.78f, 0.58f}, {0.74f, 0.56f, 0.35f}, seed);
  if (style == "tiles") return tiles(seed);
  if (style == "carpet") return carpet(seed);
  throw Error(concat("floor style '", style, "': not one of oak, walnut, pine, tiles, carpet"));
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
  throw Error(concat("wall style '", style, "': not one of plaster, stripes, dots"));
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
