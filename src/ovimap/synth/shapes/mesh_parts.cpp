// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/shapes/mesh_parts.h"

#include <algorithm>
#include <map>

namespace ovimap {

std::uint32_t add_material(TexturedMesh& mesh, SurfaceMaterial material) {
  mesh.materials.push_back(std::move(material));
  return static_cast<std::uint32_t>(mesh.materials.size() - 1);
}

void add_panel(TexturedMesh& mesh, const Eigen::Vector3f& corner, const Eigen::Vector3f& u,
               const Eigen::Vector3f& v, std::uint32_t material, const Eigen::Vector2f& uv_low,
               const Eigen::Vector2f& uv_high) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const Eigen::Vector3f normal = u.cross(v).normalized();
  for (const auto& [a, b] : {std::pair{0.f, 0.f}, {1.f, 0.f}, {1.f, 1.f}, {0.f, 1.f}}) {
    mesh.vertices.push_back(corner + a * u + b * v);
    mesh.normals.push_back(normal);
    mesh.uvs.push_back(uv_low + Eigen::Vector2f(a, b).cwiseProduct(uv_high - uv_low));
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
  mesh.triangle_materials.insert(mesh.triangle_materials.end(), 2, material);
}

void add_box(TexturedMesh& mesh, const Eigen::Vector3f& low, const Eigen::Vector3f& high,
             std::uint32_t material) {
  for (int axis = 0; axis < 3; ++axis) {
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    Eigen::Vector3f u = Eigen::Vector3f::Zero(), v = Eigen::Vector3f::Zero();
    u[next] = high[next] - low[next];
    v[last] = high[last] - low[last];
    Eigen::Vector3f far = low;
    far[axis] = high[axis];
    add_panel(mesh, far, u, v, material);
    add_panel(mesh, low, v, u, material);
  }
}

void add_mesh(TexturedMesh& mesh, const TexturedMesh& part) {
  const auto first_vertex = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto first_material = static_cast<std::uint32_t>(mesh.materials.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  mesh.normals.insert(mesh.normals.end(), part.normals.begin(), part.normals.end());
  mesh.uvs.insert(mesh.uvs.end(), part.uvs.begin(), part.uvs.end());
  mesh.materials.insert(mesh.materials.end(), part.materials.begin(), part.materials.end());
  for (const auto& [a, b, c] : part.triangles)
    mesh.triangles.push_back({first_vertex + a, first_vertex + b, first_vertex + c});
  for (const std::uint32_t material : part.triangle_materials)
    mesh.triangle_materials.push_back(first_material + material);
}

TexturedMesh placed_mesh(const TexturedMesh& model, const OrientedBox& box) {
  const Eigen::Vector3f size = bounds(model).sizes();
  const Eigen::Vector3f wanted(2 * box.half_m.x(), 2 * box.half_m.y(), box.top_m - box.bottom_m);
  Eigen::Vector3f scale = Eigen::Vector3f::Ones();
  for (int i = 0; i < 3; ++i)
    if (size[i] > 0) scale[i] = wanted[i] / size[i];
  const Eigen::Vector3f base(bounds(model).center().x(), bounds(model).center().y(),
                             bounds(model).min().z());
  const Eigen::Matrix3f turn =
      Eigen::AngleAxisf(box.yaw_rad, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  const Eigen::Vector3f place(box.center_m.x(), box.center_m.y(), box.bottom_m);
  TexturedMesh mesh = model;
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex = turn * (vertex - base).cwiseProduct(scale) + place;
  for (Eigen::Vector3f& normal : mesh.normals)
    normal = (turn * normal.cwiseQuotient(scale)).normalized();
  return mesh;
}

Eigen::AlignedBox3f bounds(const TexturedMesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex);
  return box;
}

std::string main_substance(const TexturedMesh& mesh) {
  std::map<std::string, float> areas;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const Eigen::Vector3f u = mesh.vertices[b] - mesh.vertices[a],
                          v = mesh.vertices[c] - mesh.vertices[a];
    areas[mesh.materials[mesh.triangle_materials[i]].substance] += u.cross(v).norm();
  }
  const auto most = std::max_element(
      areas.begin(), areas.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == areas.end() ? "" : most->first;
}

}  // namespace ovimap
