// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/surface/mesh_extraction.h"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "ovimap/map/rays/sphere_fixture.h"
#include "ovimap/map/surface/marching_cubes_table.h"

namespace ovimap {
namespace {

/// How often each undirected edge is used.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> edge_uses(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
  return uses;
}

TEST(MarchingCubesTable, TrianglesUseExactlyTheCrossedEdges) {
  for (std::size_t inside = 0; inside < 256; ++inside) {
    std::set<int> crossed, used;
    for (int edge = 0; edge < 12; ++edge) {
      const int a = kEdgeStart[static_cast<std::size_t>(edge)], b = a | 1 << edge_axis(edge);
      if ((inside >> a & 1) != (inside >> b & 1)) crossed.insert(edge);
    }
    const CellTriangles& cell = marching_cubes_table()[inside];
    for (std::size_t t = 0; t < cell.count; ++t)
      used.insert(cell.edges[t].begin(), cell.edges[t].end());
    EXPECT_EQ(used, crossed) << inside;
  }
}

/// A map filled with a random field: every cell case and every ambiguous face occurs.
VoxelMap random_map(std::uint32_t seed) {
  VoxelMap map;
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 2; ++x) {
        VoxelBlock& block = map.writable_block(map.find_or_create({x, y, z}));
        for (int v = 0; v < kBlockVoxels; ++v) {
          seed = seed * 1664525u + 1013904223u;
          const bool border = (x * 8 + (v & 7)) % 15 == 0 || (y * 8 + (v >> 3 & 7)) % 15 == 0 ||
                              (z * 8 + (v >> 6)) % 15 == 0;
          block.tsdf[static_cast<std::size_t>(v)] =
              static_cast<std::int16_t>(border || seed >> 31 ? 10000 : -10000);
          block.weight[static_cast<std::size_t>(v)] = 1.f;
        }
      }
  return map;
}

TEST(ExtractMesh, IsWatertightOnARandomField) {
  const Mesh mesh = extract_mesh(random_map(3));
  EXPECT_GT(mesh.triangles.size(), 1000u);
  for (const auto& [edge, uses] : edge_uses(mesh)) ASSERT_EQ(uses % 2, 0);
}

TEST(ExtractMesh, SphereIsSmoothOrientedAndLabelled) {
  const SphereScene scene;
  VoxelMap map;
  const Label label = map.labels().create();
  scene.integrate_views(map, 16, label);
  const Mesh mesh = extract_mesh(map);
  ASSERT_GT(mesh.vertices.size(), 3000u);
  std::size_t labelled = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f& p = mesh.vertices[i];
    if (std::abs(p.y()) > 0.2f) continue;  // the poles are seen at grazing angles only
    EXPECT_NEAR(p.norm(), SphereScene::kRadius, 0.004f);
    EXPECT_GT(mesh.normals[i].dot(p.normalized()), 0.8f) << "normals point outwards";
    labelled += mesh.labels[i] == label;
  }
  EXPECT_GT(labelled, mesh.vertices.size() / 2);
}

TEST(ExtractMesh, WeldsVerticesAcrossBlocks) {
  const SphereScene scene;
  VoxelMap map;
  scene.integrate_views(map, 16, map.labels().create());
  const Mesh mesh = extract_mesh(map);
  std::set<std::array<float, 3>> places;
  for (const auto& p : mesh.vertices) places.insert({p.x(), p.y(), p.z()});
  EXPECT_EQ(places.size(), mesh.vertices.size());
}

TEST(ExtractMesh, EmptyMapGivesAnEmptyMesh) {
  EXPECT_TRUE(extract_mesh(VoxelMap()).vertices.empty());
}

}  // namespace
}  // namespace ovimap
