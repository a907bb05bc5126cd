// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/shapes/solids.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ovimap/synth/shapes/angles.h"
#include "ovimap/synth/shapes/mesh_parts.h"

namespace ovimap {
namespace {

constexpr int kTurnedSides = 28, kBarSides = 8;
constexpr std::array kRoundSteps = {0.f, 0.25f, 0.6f, 1.f};  // of the radius, from the edge inwards

/// A grid of quads between `columns` x `rows` vertices that were appended row by row.
void add_grid(TexturedMesh& mesh, std::uint32_t first, std::uint32_t columns, std::uint32_t rows,
              std::uint32_t material) {
  for (std::uint32_t j = 0; j + 1 < rows; ++j)
    for (std::uint32_t i = 0; i + 1 < columns; ++i) {
      const std::uint32_t a = first + j * columns + i, b = a + 1, c = a + columns, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
      mesh.triangle_materials.insert(mesh.triangle_materials.end(), 2, material);
    }
}

void add_vertex(TexturedMesh& mesh, const Eigen::Vector3f& point, const Eigen::Vector3f& normal,
                const Eigen::Vector2f& uv) {
  mesh.vertices.push_back(point);
  mesh.normals.push_back(normal);
  mesh.uvs.push_back(uv);
}

/// Places along one side of a rounded box, -half to half.
std::vector<float> round_places(float half, float radius) {
  std::vector<float> places;
  for (const float step : kRoundSteps) places.push_back(-half + step * radius);
  for (std::size_t i = kRoundSteps.size(); i-- > 0;)
    places.push_back(half - kRoundSteps[i] * radius);
  return places;
}

}  // namespace

void add_rounded_box(TexturedMesh& mesh, const Eigen::Vector3f& low, const Eigen::Vector3f& high,
                     float radius_m, std::uint32_t material, float repeat_m) {
  const Eigen::Vector3f half = (high - low) / 2, middle = (high + low) / 2;
  const float radius = std::min(radius_m, half.minCoeff() * 0.98f);
  const Eigen::Vector3f core = half - Eigen::Vector3f::Constant(radius);
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.f, 1.f}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const auto columns = round_places(half[u], radius), rows = round_places(half[v], radius);
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const float row : rows)
        for (const float column : columns) {
          Eigen::Vector3f shell;
          shell[axis] = side * half[axis], shell[u] = column, shell[v] = row;
          const Eigen::Vector3f inner = shell.cwiseMax(-core).cwiseMin(core);
          const Eigen::Vector3f normal = (shell - inner).normalized();
          add_vertex(mesh, middle + inner + radius * normal, normal,
                     Eigen::Vector2f(column, row) / repeat_m);
        }
      add_grid(mesh, first, static_cast<std::uint32_t>(columns.size()),
               static_cast<std::uint32_t>(rows.size()), material);
    }
}

void add_board(TexturedMesh& mesh, const Eigen::Vector3f& low, const Eigen::Vector3f& high,
               std::uint32_t material, float repeat_m) {
  const Eigen::Vector3f size = high - low;
  int longest = 0;
  size.maxCoeff(&longest);
  // No two boards of a piece show the same grain.
  const Eigen::Vector2f start(7.3f * low.sum(), 5.1f * high.sum());
  for (int axis = 0; axis < 3; ++axis)
    for (const bool far : {false, true}) {
      int first = (axis + 1) % 3, second = (axis + 2) % 3;
      if (second == longest) std::swap(first, second);  // the grain runs along u
      Eigen::Vector3f u = Eigen::Vector3f::Zero(), v = u, corner = low;
      u[first] = size[first], v[second] = size[second];
      if (far) corner[axis] = high[axis];
      add_panel(mesh, corner, u, v, material, start,
                start + Eigen::Vector2f(size[first], size[second]) / repeat_m);
    }
}

void add_turned(TexturedMesh& mesh, const Eigen::Vector3f& base,
                std::span<const Eigen::Vector2f> profile, std::uint32_t material) {
  float top = 1e-6f;
  for (const Eigen::Vector2f& point : profile) top = std::max(top, point.y());
  // Each ring of quads has vertices of its own, so that the profile's corners stay sharp.
  for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
    const Eigen::Vector2f along = profile[k + 1] - profile[k];
    if (along.isZero()) continue;  // two points that are one have no ring between them
    const Eigen::Vector2f out = Eigen::Vector2f(along.y(), -along.x()).normalized();
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const std::size_t ring : {k, k + 1})
      for (int i = 0; i <= kTurnedSides; ++i) {
        const float part = static_cast<float>(i) / kTurnedSides;
        const float x = std::cos(part * kTurn_rad), y = std::sin(part * kTurn_rad);
        const Eigen::Vector2f& at = profile[ring];
        add_vertex(mesh, base + Eigen::Vector3f(at.x() * x, at.x() * y, at.y()),
                   {out.x() * x, out.x() * y, out.y()}, {part, at.y() / top});
      }
    add_grid(mesh, first, kTurnedSides + 1, 2, material);
  }
}

void add_bar(TexturedMesh& mesh, std::span<const Eigen::Vector3f> points, float radius_m,
             std::uint32_t material) {
  if (points.size() < 2) return;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Eigen::Vector3f along =
        (points[std::min(k + 1, points.size() - 1)] - points[k > 0 ? k - 1 : 0]).normalized();
    const Eigen::Vector3f side =
        along
            .cross(std::abs(along.z()) < 0.9f ? Eigen::Vector3f(0, 0, 1) : Eigen::Vector3f(1, 0, 0))
            .normalized();
    const Eigen::Vector3f other = along.cross(side);
    for (int i = 0; i <= kBarSides; ++i) {
      const float angle = kTurn_rad * static_cast<float>(i) / kBarSides;
      const Eigen::Vector3f out = std::cos(angle) * side + std::sin(angle) * other;
      add_vertex(mesh, points[k] + radius_m * out, out, {static_cast<float>(i) / kBarSides, 0});
    }
  }
  add_grid(mesh, first, kBarSides + 1, static_cast<std::uint32_t>(points.size()), material);
  for (const bool end : {false, true}) {  // caps
    const Eigen::Vector3f middle = end ? points.back() : points.front();
    const Eigen::Vector3f out =
        (end ? points.back() - points[points.size() - 2] : points[0] - points[1]).normalized();
    const auto center = static_cast<std::uint32_t>(mesh.vertices.size());
    add_vertex(mesh, middle, out, Eigen::Vector2f::Zero());
    const std::uint32_t ring =
        first + (end ? static_cast<std::uint32_t>(points.size() - 1) * (kBarSides + 1) : 0);
    for (int i = 0; i <= kBarSides; ++i)
      add_vertex(mesh, mesh.vertices[ring + static_cast<std::uint32_t>(i)], out,
                 Eigen::Vector2f::Zero());
    for (std::uint32_t i = 1; i <= kBarSides; ++i) {
      mesh.triangles.push_back({center, center + i, center + i + 1});
      mesh.triangle_materials.push_back(material);
    }
  }
}

TexturedMesh moved(TexturedMesh mesh, const Eigen::Affine3f& target_from_mesh) {
  const Eigen::Matrix3f turn = target_from_mesh.linear().inverse().transpose();
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = target_from_mesh * vertex;
  for (Eigen::Vector3f& normal : mesh.normals) normal = (turn * normal).normalized();
  return mesh;
}

}  // namespace ovimap
