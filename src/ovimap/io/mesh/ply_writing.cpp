// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>
#include <limits>

#include "ovimap/base/error.h"
#include "ovimap/image/scratch_file.h"
#include "ovimap/io/mesh/ply.h"

namespace ovimap {

namespace {

template <class Number>
void append_number(Bytes& bytes, Number value) {
  std::uint8_t number[sizeof(Number)];
  std::memcpy(number, &value, sizeof(Number));
  if constexpr (std::endian::native == std::endian::big) std::reverse(number, std::end(number));
  bytes.insert(bytes.end(), number, std::end(number));
}

void append_vector(Bytes& bytes, const Eigen::Vector3f& vector) {
  for (const float value : vector) append_number(bytes, value);
}

/// What every vertex of a file has beside its place.
struct PlyAttributes {
  explicit PlyAttributes(const Mesh& mesh)
      : normals(are_there(mesh.normals, mesh)),
        colors(are_there(mesh.colors, mesh)),
        labels(are_there(mesh.labels, mesh)) {}
  bool operator==(const PlyAttributes&) const = default;

  bool normals, colors, labels;

 private:
  template <class Value>
  static bool are_there(const std::vector<Value>& values, [[maybe_unused]] const Mesh& mesh) {
    OVIMAP_ASSERT(values.empty() || values.size() == mesh.vertices.size());
    return !values.empty();
  }
};

Bytes header_of(const PlyAttributes& has, std::uint64_t vertices, std::uint64_t triangles) {
  std::string header = concat(
      "ply\nformat binary_little_endian 1.0\ncomment metres\nelement vertex ", vertices, "\n");
  for (const char* name : {"x", "y", "z"}) header += concat("property float ", name, "\n");
  if (has.normals)
    for (const char* name : {"nx", "ny", "nz"}) header += concat("property float ", name, "\n");
  if (has.colors)
    for (const char* name : {"red", "green", "blue"})
      header += concat("property uchar ", name, "\n");
  if (has.labels) header += "property uint label\n";
  header +=
      concat("element face ", triangles, "\nproperty list uchar int vertex_indices\nend_header\n");
  return Bytes(header.begin(), header.end());
}

Bytes vertex_bytes(const Mesh& mesh) {
  constexpr std::size_t kMostVertexBytes = 31;
  Bytes bytes;
  bytes.reserve(mesh.vertices.size() * kMostVertexBytes);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    append_vector(bytes, mesh.vertices[i]);
    if (!mesh.normals.empty()) append_vector(bytes, mesh.normals[i]);
    if (!mesh.colors.empty())
      bytes.insert(bytes.end(), mesh.colors[i].begin(), mesh.colors[i].end());
    if (!mesh.labels.empty()) append_number(bytes, mesh.labels[i]);
  }
  return bytes;
}

/// `first`: number of the mesh's first vertex in the file.
Bytes face_bytes(const Mesh& mesh, std::uint32_t first) {
  constexpr std::size_t kFaceBytes = 13;
  Bytes bytes;
  bytes.reserve(mesh.triangles.size() * kFaceBytes);
  for (const auto& triangle : mesh.triangles) {
    bytes.push_back(3);
    for (const std::uint32_t index : triangle) append_number(bytes, first + index);
  }
  return bytes;
}

}  // namespace

Bytes encode_ply(const Mesh& mesh) {
  Bytes bytes = header_of(PlyAttributes(mesh), mesh.vertices.size(), mesh.triangles.size());
  for (const Bytes& body : {vertex_bytes(mesh), face_bytes(mesh, 0)})
    bytes.insert(bytes.end(), body.begin(), body.end());
  return bytes;
}

void write_ply(const std::filesystem::path& path, const Mesh& mesh) {
  write_file(path, encode_ply(mesh));
}

void write_ply(const std::filesystem::path& path, const MeshParts& parts) {
  constexpr std::uint64_t kMostVertices = std::numeric_limits<std::int32_t>::max();
  ScratchFile vertices(path), faces(path);
  PlyAttributes has{Mesh()};
  std::uint64_t vertex_count = 0, triangle_count = 0;
  parts([&](const Mesh& part) {
    if (vertex_count == 0) has = PlyAttributes(part);
    OVIMAP_ASSERT(PlyAttributes(part) == has || part.vertices.empty());
    if (vertex_count + part.vertices.size() > kMostVertices)
      throw Error(
          "the map is too large for one PLY, which numbers two thousand million vertices; "
          "export a folder instead");
    vertices.append(vertex_bytes(part));
    faces.append(face_bytes(part, static_cast<std::uint32_t>(vertex_count)));
    vertex_count += part.vertices.size();
    triangle_count += part.triangles.size();
  });
  write_file(path, header_of(has, vertex_count, triangle_count), {&vertices, &faces});
}

}  // namespace ovimap
