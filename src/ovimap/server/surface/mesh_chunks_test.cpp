// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/surface/mesh_chunks.h"

#include <gtest/gtest.h>

#include "ovimap/server/surface/surface_fixture.h"

namespace ovimap {
namespace {

constexpr float kVoxel_m = 0.01f;

TEST(MeshChunksTest, LessDetailIsSmallAndNear) {
  const Mesh mesh = fixture::wavy_sheet(120, 0.01f);
  const Mesh coarse = in_less_detail(mesh, {0.1f, 3.f}, kVoxel_m);
  EXPECT_LT(coarse.triangles.size(), mesh.triangles.size() / 3);
  EXPECT_GT(coarse.triangles.size(), 0u);
  ASSERT_EQ(coarse.labels.size(), coarse.vertices.size());
  ASSERT_EQ(coarse.normals.size(), coarse.vertices.size());
  for (const Eigen::Vector3f& vertex : coarse.vertices)
    EXPECT_NEAR(vertex.z(), fixture::sheet_height(vertex.x(), vertex.y()), 1e-4f);
}

TEST(MeshChunksTest, BordersStayWhereNeighboursMustMeet) {
  const Mesh mesh = fixture::wavy_sheet(100, 0.01f);
  const auto border_vertices = [](const Mesh& sheet) {
    std::size_t count = 0;
    for (const Eigen::Vector3f& at : sheet.vertices)
      if (at.x() < 0.1001f || at.x() > 1.0999f) ++count;
    return count;
  };
  EXPECT_EQ(border_vertices(in_less_detail(mesh, {0.05f, 10.f, true}, kVoxel_m)), 202u);
  EXPECT_LT(border_vertices(in_less_detail(mesh, {0.05f, 10.f, false}, kVoxel_m)), 100u);
}

TEST(MeshChunksTest, NothingHasNoDetail) {
  EXPECT_TRUE(in_less_detail({}, {}, kVoxel_m).triangles.empty());
}

}  // namespace
}  // namespace ovimap
