// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/surface/mesh_chunks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ovimap/server/surface/mesh_store.h"
#include "ovimap/server/surface/surface_fixture.h"

namespace ovimap {
namespace {

const ChunkGrid kMeshGrid{0.01f};

std::size_t triangles_of(const std::vector<MeshChunk>& chunks) {
  std::size_t count = 0;
  for (const MeshChunk& chunk : chunks)
    for (const SurfacePatch& patch : chunk.patches) count += patch.mesh->triangles.size();
  return count;
}

TEST(MeshChunksTest, EveryTriangleIsInOnePatchNearIt) {
  const Mesh mesh = fixture::wavy_sheet(120, 0.02f);
  const std::vector<MeshChunk> chunks = cut_into_chunks(mesh, kMeshGrid, 7);
  EXPECT_GT(chunks.size(), 3u);
  EXPECT_EQ(triangles_of(chunks), mesh.triangles.size());
  for (const MeshChunk& chunk : chunks) {
    EXPECT_EQ(chunk.version, 7u);
    for (const SurfacePatch& patch : chunk.patches) {
      EXPECT_EQ(ChunkGrid::chunk_of(patch.block), chunk.index);
      ASSERT_EQ(patch.mesh->vertices.size(), patch.mesh->labels.size());
      ASSERT_EQ(patch.mesh->vertices.size(), patch.mesh->normals.size());
      for (const auto& [a, b, c] : patch.mesh->triangles) {
        const Eigen::Vector3f center =
            (patch.mesh->vertices[a] + patch.mesh->vertices[b] + patch.mesh->vertices[c]) / 3.f;
        EXPECT_EQ(kMeshGrid.block_of(center), patch.block);
      }
    }
  }
}

TEST(MeshChunksTest, ChunksAreOrderedAndFoundByIndex) {
  MeshStore store(kMeshGrid);
  EXPECT_EQ(store.version(), 0u);
  store.replace(fixture::wavy_sheet(200, 0.02f));
  EXPECT_EQ(store.version(), 1u);
  const auto list = store.list(0);
  ASSERT_GT(list.size(), 4u);
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (i > 0) {
      EXPECT_LT(pack_index(list[i - 1].index), pack_index(list[i].index));
    }
    const auto chunk = store.find(0, list[i].index);
    ASSERT_TRUE(chunk);
    EXPECT_EQ(chunk->index, list[i].index);
  }
  EXPECT_FALSE(store.find(0, {1000, 0, 0}));
  EXPECT_TRUE(store.list(0, 1).empty());
}

TEST(MeshChunksTest, PatchesKnowHowWellTheirBlockIsKnown) {
  MeshStore store(kMeshGrid);
  EXPECT_TRUE(store.errors().empty());
  const Mesh mesh = fixture::wavy_sheet(20, 0.02f);
  const BlockIndex block = kMeshGrid.block_of((mesh.vertices[mesh.triangles[0][0]] +
                                               mesh.vertices[mesh.triangles[0][1]] +
                                               mesh.vertices[mesh.triangles[0][2]]) /
                                              3.f);
  const BlockErrors errors{{pack_index(block), 7}};
  store.replace(mesh, errors);
  EXPECT_EQ(store.errors(), errors);
  store.update({{block, 0, std::make_shared<Mesh>(mesh), 3}});
  EXPECT_EQ(store.errors().at(pack_index(block)), 3);
}

TEST(MeshChunksTest, TheCoarseLevelIsSmallAndNear) {
  const Mesh mesh = fixture::wavy_sheet(120, 0.01f);
  for (const MeshChunk& chunk : cut_into_chunks(mesh, kMeshGrid, 1)) {
    const std::size_t before = triangles_of({chunk});
    if (before < 2000) continue;
    const MeshChunk coarse = coarser_chunk(chunk, 0.1f, 0.03f);
    ASSERT_EQ(coarse.patches.size(), 1u);
    EXPECT_LT(triangles_of({coarse}), before / 3);
    EXPECT_GT(triangles_of({coarse}), 0u);
    for (const Eigen::Vector3f& vertex : coarse.patches[0].mesh->vertices)
      EXPECT_NEAR(vertex.z(), fixture::sheet_height(vertex.x(), vertex.y()), 1e-4f);
  }
}

TEST(MeshChunksTest, WeldingUndoesTheCut) {
  const Mesh mesh = fixture::wavy_sheet(40, 0.01f);
  const std::vector<MeshChunk> chunks = cut_into_chunks(mesh, kMeshGrid, 1);
  ASSERT_EQ(chunks.size(), 1u);
  std::size_t apart = 0;
  for (const SurfacePatch& patch : chunks[0].patches) apart += patch.mesh->vertices.size();
  const Mesh whole = welded(chunks[0]);
  EXPECT_GT(apart, mesh.vertices.size());
  EXPECT_EQ(whole.vertices.size(), mesh.vertices.size());
  EXPECT_EQ(whole.triangles.size(), mesh.triangles.size());
}

TEST(MeshChunksTest, AnEmptyMapHasNoChunks) {
  MeshStore store(kMeshGrid);
  store.replace({});
  EXPECT_EQ(store.version(), 1u);
  EXPECT_TRUE(store.list(1).empty());
}

}  // namespace
}  // namespace ovimap
