// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/surface/incremental_mesh.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "ovimap/map/fusion/integrate.h"
#include "ovimap/map/rays/sphere_fixture.h"
#include "ovimap/map/surface/mesh_extraction.h"
#include "ovimap/map/surface/plain_mesh.h"

namespace ovimap {
namespace {

/// A triangle by what its corners are, not by how they are numbered.
using Corner = std::array<float, 7>;  // place, colour, label
using Corners = std::vector<std::array<Corner, 3>>;

Corner corner_of(const MeshVertex& vertex) {
  return {vertex.position.x(),
          vertex.position.y(),
          vertex.position.z(),
          static_cast<float>(vertex.color[0]),
          static_cast<float>(vertex.color[1]),
          static_cast<float>(vertex.color[2]),
          static_cast<float>(vertex.label)};
}

void add_corners(const std::array<MeshVertex, 3>& triangle, Corners& corners) {
  std::array<Corner, 3> made{corner_of(triangle[0]), corner_of(triangle[1]),
                             corner_of(triangle[2])};
  std::rotate(made.begin(), std::min_element(made.begin(), made.end()), made.end());
  corners.push_back(made);
}

void add_corners(const Mesh& mesh, Corners& corners) {
  for (const auto& triangle : mesh.triangles) {
    std::array<MeshVertex, 3> made;
    for (std::size_t k = 0; k < 3; ++k)
      made[k] = {mesh.vertices[triangle[k]], mesh.colors[triangle[k]], mesh.labels[triangle[k]]};
    add_corners(made, corners);
  }
}

Corners plain_corners(const VoxelMap& map) {
  Corners corners;
  for (const plain::Corners& triangle : plain::mesh_triangles(map)) add_corners(triangle, corners);
  std::sort(corners.begin(), corners.end());
  return corners;
}

Corners whole(const VoxelMap& map) {
  Corners corners;
  add_corners(extract_mesh(map), corners);
  std::sort(corners.begin(), corners.end());
  return corners;
}

Corners in_parts(const VoxelMap& map, std::size_t triangles) {
  Corners corners;
  for_each_mesh_part(map, triangles, [&](const Mesh& part) { add_corners(part, corners); });
  std::sort(corners.begin(), corners.end());
  return corners;
}

Corners patched(const VoxelMap& map, const IncrementalMesh& mesh) {
  Corners corners;
  for (std::uint32_t slot = 0; slot < map.block_count(); ++slot)
    if (const MeshPatch* patch = mesh.patch(slot)) add_corners(patch->mesh, corners);
  std::sort(corners.begin(), corners.end());
  return corners;
}

TEST(IncrementalMesh, EqualsThePlainMeshAfterEveryFrame) {
  const SphereScene scene;
  VoxelMap map;
  IncrementalMesh mesh;
  const DepthImage depth = scene.depth();
  const IdImage segments(scene.camera.width, scene.camera.height, 1);
  const std::array<Label, 1> labels{map.labels().create()};
  for (int view = 0; view < 6; ++view) {
    const RgbImage color(scene.camera.width, scene.camera.height,
                         {static_cast<std::uint8_t>(40 * view), 90, 30});
    const auto visited = integrate(map, {.depth = depth,
                                         .camera = scene.camera,
                                         .world_from_camera = scene.pose(0.5 * view),
                                         .color = &color,
                                         .segment_ids = &segments,
                                         .segment_labels = labels});
    mesh.update(map, visited);
    const Corners expected = plain_corners(map);
    ASSERT_GT(expected.size(), 1000u);
    EXPECT_EQ(patched(map, mesh), expected) << "view " << view;
    EXPECT_EQ(whole(map), expected) << "view " << view;
    EXPECT_EQ(in_parts(map, expected.size() / 5), expected) << "view " << view;
  }
}

TEST(IncrementalMesh, EqualsThePlainMeshOnARandomField) {
  VoxelMap map;
  std::vector<std::uint32_t> slots;
  std::uint32_t seed = 5;
  for (int i = 0; i < 27; ++i) {
    slots.push_back(map.find_or_create({i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}));
    VoxelBlock& block = map.writable_block(slots.back());
    for (std::size_t v = 0; v < kBlockVoxels; ++v) {
      seed = seed * 1664525u + 1013904223u;
      block.tsdf[v] = static_cast<std::int16_t>(seed >> 16);
      block.weight[v] = seed % 16 == 0 ? 0.f : 1.f;
    }
  }
  IncrementalMesh mesh;
  mesh.update(map, slots);
  EXPECT_EQ(patched(map, mesh), plain_corners(map));
  EXPECT_EQ(whole(map), plain_corners(map));
}

TEST(IncrementalMesh, VersionsTellWhatChanged) {
  const SphereScene scene;
  VoxelMap map;
  scene.integrate_views(map, 4, map.labels().create());
  std::vector<std::uint32_t> all(map.block_count());
  for (std::uint32_t slot = 0; slot < all.size(); ++slot) all[slot] = slot;
  IncrementalMesh mesh;
  EXPECT_EQ(mesh.update(map, all), all);
  const std::vector<std::uint32_t> changed = mesh.update(map, std::span(all).first(1));
  EXPECT_LE(changed.size(), 8u) << "the block and the seven below it";
  for (const std::uint32_t slot : all) {
    const bool anew = std::binary_search(changed.begin(), changed.end(), slot);
    if (mesh.patch(slot)) {
      EXPECT_EQ(mesh.patch(slot)->version, anew ? 2u : 1u);
    }
  }
}

TEST(IncrementalMesh, AVanishedSurfaceLeavesNoPatch) {
  VoxelMap map;
  const std::uint32_t slot = map.find_or_create({0, 0, 0});
  VoxelBlock& block = map.writable_block(slot);
  block.weight.fill(1.f);
  block.tsdf.fill(100);
  block.tsdf[static_cast<std::size_t>(voxel_offset(4, 4, 4))] = -100;
  IncrementalMesh mesh;
  mesh.update(map, {&slot, 1});
  ASSERT_NE(mesh.patch(slot), nullptr);
  EXPECT_EQ(mesh.patch(slot)->mesh.triangles.size(), 8u);
  block.tsdf.fill(100);
  mesh.update(map, {&slot, 1});
  EXPECT_EQ(mesh.patch(slot), nullptr);
}

}  // namespace
}  // namespace ovimap
