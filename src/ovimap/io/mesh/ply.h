// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "ovimap/geometry/mesh.h"
#include "ovimap/image/codec.h"

namespace ovimap {

/// Writes binary little-endian PLY: float x y z, then, where the mesh has them, float nx ny nz,
/// uchar red green blue and uint label (instance id) per vertex; triangles as `vertex_indices`.
/// The file appears only when complete. Throws Error naming the path and the system's reason.
void write_ply(const std::filesystem::path& path, const Mesh& mesh);
Bytes encode_ply(const Mesh& mesh);
/// The same of a mesh in parts with the same attributes, none of which stays in memory.
void write_ply(const std::filesystem::path& path, const MeshParts& parts);

/// Reads ASCII or binary PLY of either byte order. Vertex properties may have any order and number
/// type: x y z are needed; nx ny nz, red green blue (integers, or floats in [0, 1]) and label (a
/// negative one means none) are taken when there; everything else is skipped. Polygons become fans
/// of triangles, and those with fewer than three corners are dropped. Throws Error naming the file,
/// the element, the item and the byte where it is broken.
Mesh read_ply(const std::filesystem::path& path);
/// The same from memory; `name` is what an error calls the file.
Mesh decode_ply(std::span<const std::uint8_t> bytes, const std::string& name);

/// A mesh and a whole number for each of its triangles.
struct ValuedMesh {
  Mesh mesh;
  std::vector<std::int32_t> values;
};
/// Reads PLY as read_ply does, with the faces' property `name`: every triangle has its polygon's.
/// Throws Error also when the faces lack the property.
ValuedMesh read_ply_with(const std::filesystem::path& path, const std::string& name);

}  // namespace ovimap
