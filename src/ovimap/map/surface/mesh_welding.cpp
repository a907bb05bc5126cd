// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/surface/mesh_welding.h"

#include <utility>

namespace ovimap {

void MeshWelder::add(const Mesh& part) {
  vertex_of_.resize(part.vertices.size());
  for (std::uint32_t v = 0; v < vertex_of_.size(); ++v) {
    const auto next = static_cast<std::uint32_t>(mesh_.vertices.size());
    const auto [entry, is_new] = vertex_at_.try_emplace(part.vertices[v], next);
    vertex_of_[v] = entry->second;
    if (!is_new) continue;
    mesh_.vertices.push_back(part.vertices[v]);
    if (!part.colors.empty()) mesh_.colors.push_back(part.colors[v]);
    if (!part.labels.empty()) mesh_.labels.push_back(part.labels[v]);
  }
  for (const auto& [a, b, c] : part.triangles)
    mesh_.triangles.push_back({vertex_of_[a], vertex_of_[b], vertex_of_[c]});
}

Mesh MeshWelder::take() {
  vertex_at_.clear();
  return std::exchange(mesh_, {});
}

Mesh welded(std::span<const Mesh> parts) {
  MeshWelder welder;
  for (const Mesh& part : parts) welder.add(part);
  return welder.take();
}

}  // namespace ovimap
