// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/mesh/mesh_pieces.h"

#include <algorithm>

namespace ovimap {

namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

std::uint32_t label_of(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  if (mesh.labels.empty()) return 0;
  const std::uint32_t first = mesh.labels[triangle[0]], second = mesh.labels[triangle[1]],
                      third = mesh.labels[triangle[2]];
  return second == third ? second : first;
}

template <class Value>
std::vector<Value> chosen(const std::vector<Value>& values,
                          const std::vector<std::uint32_t>& indices) {
  std::vector<Value> result;
  if (values.empty()) return result;
  result.reserve(indices.size());
  for (const std::uint32_t index : indices) result.push_back(values[index]);
  return result;
}

template <class Value>
void append(const std::vector<Value>& from, std::vector<Value>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

/// The triangles with the vertices that they need.
Mesh piece_of(const Mesh& mesh, Triangles triangles) {
  std::vector<std::uint32_t> used;
  used.reserve(3 * triangles.size());
  for (const auto& triangle : triangles) used.insert(used.end(), triangle.begin(), triangle.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (auto& triangle : triangles)
    for (std::uint32_t& corner : triangle)
      corner = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), corner) -
                                          used.begin());
  Mesh piece;
  piece.vertices = chosen(mesh.vertices, used);
  piece.normals = chosen(mesh.normals, used);
  piece.colors = chosen(mesh.colors, used);
  piece.labels = chosen(mesh.labels, used);
  piece.triangles = std::move(triangles);
  return piece;
}

}  // namespace

void append(const Mesh& part, Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  append(part.vertices, mesh.vertices);
  append(part.normals, mesh.normals);
  append(part.colors, mesh.colors);
  append(part.labels, mesh.labels);
  for (const auto& [a, b, c] : part.triangles)
    mesh.triangles.push_back({first + a, first + b, first + c});
}

std::map<std::uint32_t, Mesh> split_by_label(const Mesh& mesh) {
  std::map<std::uint32_t, Triangles> triangles;
  for (const auto& triangle : mesh.triangles)
    triangles[label_of(mesh, triangle)].push_back(triangle);
  std::map<std::uint32_t, Mesh> pieces;
  for (auto& [label, list] : triangles) pieces.emplace(label, piece_of(mesh, std::move(list)));
  return pieces;
}

Mesh without_labels(const Mesh& mesh, const std::function<bool(std::uint32_t)>& drop) {
  Triangles kept;
  for (const auto& triangle : mesh.triangles)
    if (!drop(label_of(mesh, triangle))) kept.push_back(triangle);
  return piece_of(mesh, std::move(kept));
}

}  // namespace ovimap
