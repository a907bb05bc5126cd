// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/procedural/prints.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ovimap {
namespace {

PaintColor any_color(Random& random, float low, float high) {
  return {random.uniform(low, high), random.uniform(low, high), random.uniform(low, high)};
}

/// Two octaves of noise.
float cloud(const LatticeNoise& noise, float x, float y) {
  return 0.65f * noise.at(x, y, 512, 512) + 0.35f * noise.at(2.3f * x, 2.3f * y, 512, 512);
}

/// Hills one behind the other under a sky, or waves under one.
Paint landscape(std::uint64_t seed) {
  Random random(seed);
  const LatticeNoise noise(random.bits());
  const PaintColor high = any_color(random, 0.3f, 0.75f), low = any_color(random, 0.6f, 0.98f);
  const PaintColor near = any_color(random, 0.05f, 0.4f);
  const float sun_x = random.uniform(0.2f, 0.8f), sun_y = random.uniform(0.15f, 0.4f);
  const int ridges = 3 + static_cast<int>(random.index(3));
  return [=](float x, float y) {
    PaintColor color =
        mixed(high, low, smooth_step(0, 0.7f, y + 0.2f * cloud(noise, 4 * x, 9 * y)));
    const float sun = std::hypot(x - sun_x, y - sun_y);
    color = mixed(color, {1, 0.95f, 0.8f}, 1 - smooth_step(0.04f, 0.14f, sun));
    for (int i = 0; i < ridges; ++i) {
      const float depth = static_cast<float>(i + 1) / static_cast<float>(ridges);
      const float line =
          0.35f + 0.5f * depth - 0.22f * cloud(noise, (2 + 3 * depth) * x + 17 * depth, 3 * depth);
      const float grain = 0.8f + 0.4f * cloud(noise, 30 * x, 30 * y + 100 * depth);
      const PaintColor ridge = mixed(low, near * grain, 0.3f + 0.7f * depth);
      color = mixed(color, ridge, smooth_step(line - 0.006f, line + 0.006f, y));
    }
    return color;
  };
}

/// A face or two before a blurred ground.
Paint portrait(std::uint64_t seed) {
  Random random(seed);
  const LatticeNoise noise(random.bits());
  const PaintColor ground = any_color(random, 0.2f, 0.7f), coat = any_color(random, 0.1f, 0.8f);
  const PaintColor skin{random.uniform(0.45f, 0.9f), random.uniform(0.35f, 0.65f), 0.4f};
  const PaintColor hair = any_color(random, 0.05f, 0.35f);
  const float shift = random.uniform(-0.12f, 0.12f);
  return [=](float x, float y) {
    PaintColor color = ground * (0.6f + 0.7f * cloud(noise, 3 * x, 3 * y));
    const float u = x - 0.5f - shift;
    const auto oval = [&](float cy, float rx, float ry) {
      return 1 - smooth_step(0.93f, 1.02f, std::hypot(u / rx, (y - cy) / ry));
    };
    color = mixed(color, coat * (0.8f + 0.3f * cloud(noise, 12 * x, 12 * y)),
                  oval(1.05f, 0.42f, 0.42f));
    color = mixed(color, hair, oval(0.37f, 0.19f, 0.26f));
    color =
        mixed(color, skin * (1.f - 0.5f * std::abs(u + 0.03f) / 0.2f), oval(0.43f, 0.145f, 0.21f));
    for (const float eye : {-0.055f, 0.055f})
      color = mixed(color, {0.1f, 0.08f, 0.08f},
                    1 - smooth_step(0.012f, 0.02f, std::hypot(u - eye, y - 0.4f)));
    return mixed(color, {0.6f, 0.2f, 0.2f},
                 1 - smooth_step(0.8f, 1.f, std::hypot(u / 0.05f, (y - 0.53f) / 0.012f)));
  };
}

/// A street of houses at dusk, windows lit here and there.
Paint skyline(std::uint64_t seed) {
  Random random(seed);
  const LatticeNoise noise(random.bits());
  const PaintColor sky = any_color(random, 0.2f, 0.9f), wall = any_color(random, 0.1f, 0.5f);
  const int houses = 6 + static_cast<int>(random.index(8));
  return [=](float x, float y) {
    const float house = std::floor(x * static_cast<float>(houses));
    const float roof = 0.25f + 0.45f * noise.at(house * 3.1f, 0.5f, 512, 512);
    if (y < roof)
      return PaintColor(mixed(sky, {0.95f, 0.8f, 0.7f}, y) *
                        (0.85f + 0.2f * cloud(noise, 5 * x, 12 * y)));
    const PaintColor stone = wall * (0.6f + 0.9f * noise.at(house * 5.7f, 7.5f, 512, 512));
    const float u = part_of(x * static_cast<float>(houses) * 4), v = part_of(y * 26);
    const bool pane = u > 0.25f && u < 0.75f && v > 0.2f && v < 0.75f;
    const float lit = noise.at(std::floor(x * static_cast<float>(houses) * 4) * 2 + 0.5f,
                               std::floor(y * 26) * 2 + 0.5f, 512, 512);
    if (!pane) return stone;
    return lit > 0.55f ? PaintColor(1.f, 0.85f, 0.5f) : PaintColor(stone * 0.45f);
  };
}

/// Petals round a middle, several of them.
Paint flowers(std::uint64_t seed) {
  struct Flower {
    float x, y, radius, petals, turn;
    PaintColor color;
  };
  Random random(seed);
  const LatticeNoise noise(random.bits());
  const PaintColor leaf = any_color(random, 0.1f, 0.5f);
  std::vector<Flower> all;
  for (std::size_t i = 0; i < 5 + random.index(8); ++i)
    all.push_back({random.uniform(), random.uniform(), random.uniform(0.08f, 0.25f),
                   static_cast<float>(4 + random.index(5)), random.uniform(0, 6),
                   any_color(random, 0.3f, 1)});
  return [=](float x, float y) {
    PaintColor color = leaf * (0.5f + 0.9f * cloud(noise, 9 * x, 9 * y));
    for (const Flower& flower : all) {
      const float dx = x - flower.x, dy = y - flower.y, far = std::hypot(dx, dy) / flower.radius;
      const float edge = 0.65f + 0.35f * std::cos(flower.petals * std::atan2(dy, dx) + flower.turn);
      color = mixed(color, flower.color * (0.55f + 0.5f * far),
                    1 - smooth_step(edge - 0.06f, edge, far));
      color = mixed(color, {0.85f, 0.65f, 0.15f}, 1 - smooth_step(0.18f, 0.24f, far));
    }
    return color;
  };
}

/// 1 where a letter's stroke lies: words of random length in lines.
float written(const LatticeNoise& noise, float column, float line, float share_of_line) {
  const float row = std::floor(line), v = line - row;
  if (v < 0.25f || v > 0.72f) return 0;
  if (column > 90 * (0.55f + 0.45f * noise.at(row * 2 + 0.5f, 3.5f, 512, 512)) * share_of_line)
    return 0;
  const float letter = std::floor(column);
  if (noise.at(letter * 1.7f, row * 3 + 0.5f, 512, 512) > 0.72f) return 0;  // between words
  return noise.at(column * 2.5f, line * 9, 512, 512) > 0.42f ? 1.f : 0.f;
}

}  // namespace

Paint photograph(Split split, std::uint64_t seed) {
  const bool first = Random(seed).index(2) == 0;
  if (split == Split::kTuned) return first ? landscape(seed) : portrait(seed);
  return first ? skyline(seed) : flowers(seed);
}

Paint view_outside(Split split, std::uint64_t seed) {
  return split == Split::kTuned ? landscape(seed) : skyline(seed);
}

Paint screen_picture(Split split, std::uint64_t seed) {
  Random random(seed);
  const LatticeNoise noise(random.bits());
  const Paint wallpaper = photograph(split, random.bits()),
              shown = photograph(split, random.bits());
  const float left = random.uniform(0.04f, 0.3f), right = random.uniform(0.6f, 0.96f);
  const float top = random.uniform(0.06f, 0.2f), bottom = random.uniform(0.7f, 0.92f);
  const bool dark = random.index(2) == 0, full = random.index(3) == 0;
  const PaintColor page = dark ? PaintColor(0.1f, 0.11f, 0.13f) : PaintColor(0.96f, 0.96f, 0.97f);
  const PaintColor ink = dark ? PaintColor(0.6f, 0.8f, 0.65f) : PaintColor(0.15f, 0.15f, 0.2f);
  const PaintColor bar = any_color(random, 0.1f, 0.6f);
  if (full) return wallpaper;
  return [=](float x, float y) {
    if (y > 0.95f) return PaintColor(bar * (part_of(x * 24) > 0.3f && x < 0.4f ? 2.f : 0.6f));
    if (x < left || x > right || y < top || y > bottom) return wallpaper(x, y);
    const float u = (x - left) / (right - left), v = (y - top) / (bottom - top);
    if (v < 0.05f) return bar;
    if (split == Split::kUnseen && u > 0.55f && v > 0.12f && v < 0.6f)
      return shown(u * 2 - 1, v * 2);
    if (split == Split::kTuned && u < 0.2f) return PaintColor(mixed(page, bar, 0.3f));
    return PaintColor(mixed(page, ink, written(noise, u * 100, v * 34, 0.9f)));
  };
}

Paint printed_page(Split split, std::uint64_t seed) {
  Random random(seed);
  const LatticeNoise noise(random.bits());
  const PaintColor paper = PaintColor::Constant(random.uniform(0.86f, 0.96f)) +
                           PaintColor{0.02f, 0.01f, random.uniform(-0.06f, 0.02f)};
  const bool figure = random.index(3) == 0, columns = split == Split::kUnseen;
  const Paint shown = photograph(split, random.bits());
  const PaintColor headline = any_color(random, 0.05f, 0.5f);
  return [=](float x, float y) {
    if (x < 0.08f || x > 0.92f || y < 0.07f || y > 0.93f) return paper;
    const float u = (x - 0.08f) / 0.84f, v = (y - 0.07f) / 0.86f;
    if (v < 0.06f) return PaintColor(mixed(paper, headline, written(noise, u * 40, v * 16, 0.5f)));
    if (figure && v > 0.5f && v < 0.8f && u > 0.1f && u < 0.9f) return shown(u, (v - 0.5f) / 0.3f);
    if (columns && std::abs(u - 0.5f) < 0.02f) return paper;
    const float column = columns ? part_of(u * 2) * 50 : u * 95;
    const bool gap = noise.at(std::floor(v * 48) * 2 + 0.5f, 9.5f, 512, 512) > 0.78f;  // paragraphs
    return gap ? paper
               : PaintColor(
                     mixed(paper, {0.2f, 0.2f, 0.22f}, 0.8f * written(noise, column, v * 48, 1)));
  };
}

Paint cover(Split split, std::uint64_t seed) {
  Random random(seed);
  const LatticeNoise noise(random.bits());
  const PaintColor ground = any_color(random, 0.08f, 0.9f), accent = any_color(random, 0.1f, 1);
  const PaintColor ink =
      ground.mean() > 0.5f ? PaintColor(0.1f, 0.1f, 0.12f) : PaintColor(0.95f, 0.94f, 0.9f);
  const Paint shown = photograph(split, random.bits());
  const float title = random.uniform(0.08f, 0.3f), band = random.uniform(0.5f, 0.8f);
  const std::size_t style = random.index(3);
  return [=](float x, float y) {
    const float letters = y > title && y < title + 0.16f && x > 0.1f && x < 0.9f
                              ? written(noise, x * 24, (y - title) * 12, 0.4f)
                              : 0.f;
    PaintColor color = ground;
    if (style == 0 && y > 0.42f && y < 0.92f && x > 0.1f && x < 0.9f)
      color = shown(x, (y - 0.42f) / 0.5f);
    if (style == 1)
      color = split == Split::kTuned ? (y > band ? accent : ground)
                                     : (x + 0.4f * y > band ? accent : ground);
    if (style == 2) color = shown(x, y);
    return PaintColor(mixed(color, ink, letters));
  };
}

Paint key_rows(int columns, int rows, const PaintColor& keys, const PaintColor& ground,
               std::uint64_t seed) {
  const LatticeNoise noise(seed);
  return [=](float x, float y) {
    const float row = std::floor(y * static_cast<float>(rows)),
                v = y * static_cast<float>(rows) - row;
    const float column = x * static_cast<float>(columns) + 0.35f * row, u = part_of(column);
    const bool space_bar = row == static_cast<float>(rows - 1) && x > 0.25f && x < 0.6f;
    if (v < 0.1f || v > 0.9f || (!space_bar && (u < 0.1f || u > 0.9f))) return ground;
    const bool mark = !space_bar && std::abs(u - 0.4f) < 0.14f && std::abs(v - 0.4f) < 0.16f &&
                      noise.at(column * 6, y * 60, 512, 512) > 0.5f;
    return mark ? PaintColor(
                      mixed(keys, PaintColor::Constant(keys.mean() > 0.5f ? 0.1f : 0.9f), 0.8f))
                : keys;
  };
}

Paint rug_motif(Split split, float width_m, float depth_m, std::uint64_t seed) {
  Random random(seed);
  const LatticeNoise noise(random.bits());
  const PaintColor ground = any_color(random, 0.15f, 0.75f),
                   figure = any_color(random, 0.1f, 0.85f), third = any_color(random, 0.2f, 0.9f);
  const float cells = random.uniform(3, 7), border = random.uniform(0.05f, 0.16f);
  const std::size_t style = random.index(2);
  const auto wool = [noise](float x, float y) {
    return 0.82f + 0.3f * noise.at(x * 380, y * 380, 512, 512);
  };
  if (split == Split::kTuned)  // stripes with zigzags, or a lattice of rhombs
    return [=](float x, float y) {
      const float u = x * width_m * cells, v = y * depth_m * cells;
      const float edge = std::min(std::min(x, 1 - x) * width_m, std::min(y, 1 - y) * depth_m);
      PaintColor color = ground;
      if (style == 0)
        color = part_of(u + 0.5f * std::abs(part_of(v) - 0.5f)) < 0.4f ? figure
                : part_of(u) > 0.8f                                    ? third
                                                                       : ground;
      if (style == 1)
        color = std::abs(part_of(u) - 0.5f) + std::abs(part_of(v) - 0.5f) < 0.3f ? figure : ground;
      if (edge < border) color = edge < border / 2 ? third : figure;
      return PaintColor(color * wool(x, y));
    };
  return [=](float x, float y) {  // a medallion among blossoms, or patches with soft rims
    const float edge = std::min(std::min(x, 1 - x) * width_m, std::min(y, 1 - y) * depth_m);
    PaintColor color = ground;
    if (style == 0) {
      const float far = std::hypot((x - 0.5f) * width_m, (y - 0.5f) * depth_m) /
                        (0.4f * std::min(width_m, depth_m));
      const float angle = std::atan2(y - 0.5f, x - 0.5f);
      const float blossom =
          std::hypot(part_of(x * width_m * cells) - 0.5f, part_of(y * depth_m * cells) - 0.5f);
      if (blossom < 0.18f) color = third;
      if (far < 0.85f + 0.15f * std::cos(12 * angle))
        color = part_of(far * 4) < 0.3f ? third : figure;
      if (edge < border) color = part_of((x + y) * 18) < 0.5f ? figure : third;
    } else {
      const float patch = cloud(noise, x * width_m * 2, y * depth_m * 2);
      color = mixed(mixed(ground, figure, smooth_step(0.42f, 0.48f, patch)), third,
                    smooth_step(0.6f, 0.64f, patch));
    }
    return PaintColor(color * wool(x, y));
  };
}

}  // namespace ovimap
