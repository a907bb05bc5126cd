// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/procedural/craft.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ovimap {
namespace {

constexpr int kMaterial_px = 256;
constexpr float kPrint_px_m = 1400;  // letters of a page are some pixels high
constexpr int kLargestPrint_px = 900;
constexpr float kProud_m = 4e-4f;

SurfaceMaterial textured(std::shared_ptr<const Texture> texture, float emission = 0,
                         const char* substance = "") {
  SurfaceMaterial material;
  material.substance = substance;
  material.texture = std::move(texture);
  material.emission.setConstant(emission);
  return material;
}

/// Long grain with pores, or rings with knots.
Paint grain(Split split, std::uint64_t seed) {
  Random random(seed);
  static constexpr std::array<std::array<float, 6>, 4> kTunedWoods = {
      {{0.84f, 0.70f, 0.52f, 0.70f, 0.52f, 0.34f},
       {0.62f, 0.45f, 0.30f, 0.44f, 0.29f, 0.18f},
       {0.93f, 0.86f, 0.74f, 0.84f, 0.74f, 0.60f},
       {0.40f, 0.30f, 0.24f, 0.27f, 0.19f, 0.15f}}};
  static constexpr std::array<std::array<float, 6>, 4> kUnseenWoods = {
      {{0.76f, 0.56f, 0.40f, 0.60f, 0.38f, 0.26f},
       {0.87f, 0.80f, 0.70f, 0.76f, 0.68f, 0.57f},
       {0.50f, 0.32f, 0.22f, 0.34f, 0.20f, 0.13f},
       {0.70f, 0.66f, 0.60f, 0.56f, 0.52f, 0.46f}}};
  const auto& c = (split == Split::kTuned ? kTunedWoods : kUnseenWoods)[random.index(4)];
  const PaintColor light(c[0], c[1], c[2]), dark(c[3], c[4], c[5]);
  const LatticeNoise noise(random.bits());
  const bool rings = split == Split::kUnseen;
  return [=](float x, float y) {
    const float broad = noise.at(x * 2, y * 12, 2, 12), fine = noise.at(x * 8, y * 128, 8, 128);
    const float figure =
        rings ? 0.5f + 0.5f * std::sin(40 * y + 9 * noise.at(x * 3, y * 4, 3, 4)) : broad;
    return PaintColor(mixed(light, dark, 0.55f * figure + 0.35f * fine));
  };
}

struct Weave {
  Paint paint;
  const char* substance;
};

Weave weave(Split split, std::uint64_t seed) {
  Random random(seed);
  // Upholstery is mostly pale or grey: little contrast between a thing and what is beside it.
  const float value =
      random.index(3) == 0 ? random.uniform(0.15f, 0.5f) : random.uniform(0.6f, 0.93f);
  const PaintColor base =
      PaintColor::Constant(value) +
      0.12f * PaintColor{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  const PaintColor other = mixed(base, PaintColor::Constant(random.uniform(0.1f, 0.95f)), 0.3f);
  const LatticeNoise noise(random.bits());
  const std::size_t style = random.index(4);  // half of all cloths are plain
  static constexpr const char* kTunedStyles[] = {"striped cloth", "dotted cloth", "cloth", "cloth"};
  static constexpr const char* kUnseenStyles[] = {"checked cloth", "zigzag cloth", "cloth",
                                                  "cloth"};
  const auto paint = [=](float x, float y) {
    const float thread = 0.93f + 0.1f * noise.at(x * 128, y * 128, 128, 128);
    bool figure = false;
    if (style == 0)
      figure = split == Split::kTuned ? part_of(x * 16) < 0.3f
                                      : (part_of(x * 8) < 0.3f) != (part_of(y * 8) < 0.3f);
    if (style == 1)
      figure = split == Split::kTuned
                   ? std::hypot(part_of(x * 10) - 0.5f, part_of(y * 10) - 0.5f) < 0.2f
                   : part_of(y * 16 + std::abs(part_of(x * 8) - 0.5f) * 2) < 0.45f;
    return PaintColor((figure ? other : base) * thread);
  };
  return {paint, (split == Split::kTuned ? kTunedStyles : kUnseenStyles)[style]};
}

}  // namespace

std::uint32_t Craft::wood(TexturedMesh& mesh) {
  return add_material(
      mesh, textured(painted(kMaterial_px, kMaterial_px, grain(split, random.bits())), 0, "wood"));
}

std::uint32_t Craft::cloth(TexturedMesh& mesh) {
  const Weave woven = weave(split, random.bits());
  return add_material(
      mesh, textured(painted(kMaterial_px, kMaterial_px, woven.paint), 0, woven.substance));
}

std::uint32_t Craft::plain(TexturedMesh& mesh, const PaintColor& srgb, float emission,
                           const char* substance) {
  SurfaceMaterial material;
  material.substance = substance;
  for (int i = 0; i < 3; ++i)
    material.albedo[i] =
        linear_from_srgb(static_cast<std::uint8_t>(std::clamp(srgb[i], 0.f, 1.f) * 255));
  material.emission.setConstant(emission);
  return add_material(mesh, material);
}

std::uint32_t Craft::lacquer(TexturedMesh& mesh) {
  const PaintColor tint{between(-1, 1), between(-1, 1), between(-1, 1)};
  return plain(
      mesh,
      PaintColor::Constant(one_in(4) ? between(0.25f, 0.6f) : between(0.8f, 0.95f)) + 0.06f * tint,
      0, "lacquer");
}

std::uint32_t Craft::metal(TexturedMesh& mesh) {
  return plain(mesh, PaintColor::Constant(one_in(2) ? between(0.08f, 0.2f) : between(0.5f, 0.8f)),
               0, "metal");
}

std::uint32_t Craft::plastic(TexturedMesh& mesh) {
  return plain(mesh, PaintColor::Constant(one_in(3) ? between(0.75f, 0.93f) : between(0.06f, 0.3f)),
               0, "plastic");
}

std::uint32_t Craft::glaze(TexturedMesh& mesh) {
  const PaintColor base{between(0.1f, 0.95f), between(0.1f, 0.95f), between(0.1f, 0.95f)};
  const PaintColor body = one_in(2) ? PaintColor(0.93f, 0.92f, 0.9f) : base,
                   mark = one_in(2) ? base : PaintColor(0.2f, 0.2f, 0.25f);
  const LatticeNoise noise(random.bits());
  const std::size_t style = random.index(3);
  const float low = between(0.2f, 0.5f), high = low + between(0.1f, 0.4f);
  const bool speckled = split == Split::kUnseen;
  return add_material(
      mesh, textured(painted(128, 128,
                             [=](float x, float y) {
                               if (style == 0) return body;
                               if (speckled)
                                 return noise.at(x * 40, y * 40, 40, 40) > 0.74f ? mark : body;
                               return y > low && y < high ? mark : body;
                             }),
                     0, "ceramic"));
}

std::uint32_t Craft::print(TexturedMesh& mesh, float width_m, float height_m, const Paint& paint,
                           float emission) {
  const auto pixels = [](float metres) {
    return std::clamp(static_cast<int>(metres * kPrint_px_m), 16, kLargestPrint_px);
  };
  return add_material(mesh, textured(painted(pixels(width_m), pixels(height_m), paint), emission));
}

void add_top_print(TexturedMesh& mesh, const Eigen::Vector2f& low, const Eigen::Vector2f& high,
                   float top_m, std::uint32_t material) {
  add_panel(mesh, {low.x(), low.y(), top_m + kProud_m}, {high.x() - low.x(), 0, 0},
            {0, high.y() - low.y(), 0}, material);
}

void add_front_print(TexturedMesh& mesh, float left, float right, float bottom, float top, float y,
                     std::uint32_t material) {
  add_panel(mesh, {left, y - kProud_m, bottom}, {right - left, 0, 0}, {0, 0, top - bottom},
            material);
}

}  // namespace ovimap
