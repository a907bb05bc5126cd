// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/surface/chunk_encoding.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace ovimap {

namespace {

static_assert(std::endian::native == std::endian::little,
              "chunks are written as they lie in memory");

constexpr std::uint16_t kFormatVersion = 2;

class ByteWriter {
 public:
  template <class Value>
  void put(Value value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    bytes_.append(bytes, sizeof value);
  }
  void put(const Eigen::Vector3i& value) {
    for (int i = 0; i < 3; ++i) put(static_cast<std::int32_t>(value[i]));
  }
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// A unit vector on an octahedron folded into a square, 8 bits an axis (Meyer et al. 2010, "On
/// floating-point normal vectors").
std::uint16_t octahedral(const Eigen::Vector3f& normal) {
  const float sum = normal.cwiseAbs().sum();
  if (!(sum > 0.f)) return 0x8080;
  Eigen::Vector2f folded = normal.head<2>() / sum;
  if (normal.z() < 0.f) {
    const Eigen::Vector2f upper = folded;
    folded.x() = (1.f - std::abs(upper.y())) * (upper.x() < 0.f ? -1.f : 1.f);
    folded.y() = (1.f - std::abs(upper.x())) * (upper.y() < 0.f ? -1.f : 1.f);
  }
  const auto byte = [](float value) {
    return static_cast<std::uint16_t>(std::lround((value * 0.5f + 0.5f) * 255.f));
  };
  return static_cast<std::uint16_t>(byte(folded.x()) << 8 | byte(folded.y()));
}

std::uint16_t sixteen_bits(float share) {
  constexpr float kSteps = 65535.f;
  return static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.f, 1.f) * kSteps));
}

template <class Visit>
void for_each_newer(const MeshChunk& chunk, std::uint64_t since, Visit&& visit) {
  for (const SurfacePatch& patch : chunk.patches)
    if (patch.version > since) visit(patch);
}

void put_header(ByteWriter& out, const MeshChunk& chunk, const ChunkGrid& grid, int level,
                const ChunkTotals& totals) {
  for (const char letter : {'O', 'V', 'M', 'C'}) out.put(letter);
  out.put(kFormatVersion);
  out.put(static_cast<std::uint16_t>(level));
  out.put(chunk.index);
  const Eigen::Vector3f origin = grid.origin(chunk.index);
  for (int i = 0; i < 3; ++i) out.put(origin[i]);
  out.put(grid.edge_m());
  out.put(totals.patches);
  out.put(totals.vertices);
  out.put(totals.triangles);
  out.put(chunk.version);
}

void put_positions(ByteWriter& out, const Mesh& mesh, const ChunkGrid& grid,
                   const Eigen::Vector3f& origin) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Eigen::Vector3f place = (mesh.vertices[v] - origin) / grid.edge_m();
    for (int i = 0; i < 3; ++i) out.put(sixteen_bits(place[i]));
    out.put(mesh.normals.empty() ? std::uint16_t{0x8080} : octahedral(mesh.normals[v]));
  }
}

/// How well the surface around a vertex is known; 0: not told.
std::uint8_t error_at(const Eigen::Vector3f& vertex, const ChunkGrid& grid,
                      const BlockErrors& errors) {
  const auto found = errors.find(pack_index(grid.block_of(vertex)));
  return found == errors.end() ? std::uint8_t{0} : found->second;
}

void put_colors(ByteWriter& out, const SurfacePatch& patch, const ChunkGrid& grid,
                const BlockErrors& errors) {
  const Mesh& mesh = *patch.mesh;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (std::size_t c = 0; c < 3; ++c)
      out.put(mesh.colors.empty() ? std::uint8_t{160} : mesh.colors[v][c]);
    out.put(patch.error > 0 ? patch.error : error_at(mesh.vertices[v], grid, errors));
  }
}

}  // namespace

std::string encode_chunk(const MeshChunk& chunk, const ChunkGrid& grid, int level,
                         std::uint64_t since, const BlockErrors& errors) {
  const ChunkTotals totals = totals_of(chunk, since);
  ByteWriter out;
  out.reserve(56 + 28 * std::size_t{totals.patches} + 16 * std::size_t{totals.vertices} +
              12 * std::size_t{totals.triangles});
  put_header(out, chunk, grid, level, totals);
  for_each_newer(chunk, since, [&](const SurfacePatch& patch) {
    out.put(patch.block);
    out.put(static_cast<std::uint32_t>(patch.mesh->vertices.size()));
    out.put(static_cast<std::uint32_t>(patch.mesh->triangles.size()));
    out.put(patch.version);
  });
  const Eigen::Vector3f origin = grid.origin(chunk.index);
  for_each_newer(chunk, since,
                 [&](const SurfacePatch& patch) { put_positions(out, *patch.mesh, grid, origin); });
  for_each_newer(chunk, since,
                 [&](const SurfacePatch& patch) { put_colors(out, patch, grid, errors); });
  for_each_newer(chunk, since, [&](const SurfacePatch& patch) {
    for (std::size_t v = 0; v < patch.mesh->vertices.size(); ++v)
      out.put(patch.mesh->labels.empty() ? std::uint32_t{0} : patch.mesh->labels[v]);
  });
  std::uint32_t first = 0;
  for_each_newer(chunk, since, [&](const SurfacePatch& patch) {
    for (const auto& triangle : patch.mesh->triangles)
      for (const std::uint32_t corner : triangle) out.put(first + corner);
    first += static_cast<std::uint32_t>(patch.mesh->vertices.size());
  });
  return out.take();
}

}  // namespace ovimap
