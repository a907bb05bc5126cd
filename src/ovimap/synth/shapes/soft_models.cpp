// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/shapes/soft_models.h"

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "ovimap/synth/shapes/mesh_parts.h"
#include "ovimap/synth/shapes/random.h"
#include "ovimap/synth/shapes/surface_patterns.h"

namespace ovimap {
namespace {

constexpr int kGridCells = 24;  // of the grid across each side
constexpr std::array<const char*, 3> kCloths = {"plaster", "stripes", "dots"};
constexpr float kFoldShare = 0.35f;  // of a blanket's thickness

/// The height over a sheet's plane at (u, v), both -1..1 over its width and depth.
using SheetHeight = std::function<float(float u, float v)>;

SurfaceMaterial cloth(Random& random) {
  const auto shade = [&] { return static_cast<std::uint8_t>(random.uniform(60, 230)); };
  const Rgb8 color = {shade(), shade(), shade()};
  SurfaceMaterial material;
  material.texture =
      wall_pattern(kCloths[random.index(kCloths.size())], color, random.bits()).texture;
  return material;
}

float coordinate(int cell) {
  return 2.f * static_cast<float>(cell) / kGridCells - 1;
}

/// One side of a soft thing; `up` says which way it faces.
void add_sheet(TexturedMesh& mesh, const Eigen::Vector3f& size, const SheetHeight& height,
               std::uint32_t material, bool up) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto point = [&](float u, float v) {
    return Eigen::Vector3f(u * size.x() / 2, v * size.y() / 2, height(u, v));
  };
  constexpr float kStep = 0.5f / kGridCells;
  for (int j = 0; j <= kGridCells; ++j)
    for (int i = 0; i <= kGridCells; ++i) {
      const float u = coordinate(i), v = coordinate(j);
      const Eigen::Vector3f along = point(u + kStep, v) - point(u - kStep, v);
      const Eigen::Vector3f across = point(u, v + kStep) - point(u, v - kStep);
      mesh.vertices.push_back(point(u, v));
      mesh.normals.push_back(along.cross(across).normalized() * (up ? 1.f : -1.f));
      mesh.uvs.push_back({(u + 1) / 2, (v + 1) / 2});
    }
  for (int j = 0; j < kGridCells; ++j)
    for (int i = 0; i < kGridCells; ++i) {
      const auto a = first + static_cast<std::uint32_t>(j * (kGridCells + 1) + i);
      const std::uint32_t b = a + 1, c = a + kGridCells + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
      mesh.triangle_materials.insert(mesh.triangle_materials.end(), 2, material);
    }
}

/// 1 in the middle, 0 along the rim, steep near it; 0 beyond.
float swelling(float u, float v) {
  const float x = 1 - std::pow(u, 4.f), y = 1 - std::pow(v, 4.f);
  return std::sqrt(std::max(0.f, x) * std::max(0.f, y));
}

}  // namespace

TexturedMesh pillow_model(const Eigen::Vector3f& size, std::uint64_t seed) {
  Random random(seed);
  TexturedMesh mesh;
  const auto material = add_material(mesh, cloth(random));
  const float half = size.z() / 2;
  add_sheet(
      mesh, size, [&](float u, float v) { return half * (1 + swelling(u, v)); }, material, true);
  add_sheet(
      mesh, size, [&](float u, float v) { return half * (1 - swelling(u, v)); }, material, false);
  return mesh;
}

TexturedMesh blanket_model(const Eigen::Vector3f& size, std::uint64_t seed) {
  Random random(seed);
  TexturedMesh mesh;
  const auto material = add_material(mesh, cloth(random));
  const float turns = std::numbers::pi_v<float> * random.uniform(3, 6),
              start = random.uniform(0, 6);
  const float slant = random.uniform(-1, 1);
  const auto folds = [&](float u, float v) {
    const float fold = 0.5f + 0.5f * std::sin(start + turns * (u + slant * v));
    return size.z() * swelling(u, v) * (1 - kFoldShare * fold);
  };
  add_sheet(mesh, size, folds, material, true);
  return mesh;
}

}  // namespace ovimap
