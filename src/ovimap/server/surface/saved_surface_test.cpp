// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/surface/saved_surface.h"

#include <array>
#include <future>
#include <map>

#include <gtest/gtest.h>

#include "ovimap/io/map_file/map_file_fixture.h"
#include "ovimap/io/map_file/saved_tiles.h"
#include "ovimap/map/rays/sphere_fixture.h"
#include "ovimap/map/surface/mesh_extraction.h"

namespace ovimap {
namespace {

/// A sphere that lies in several chunks.
VoxelMap sphere_map() {
  VoxelMap map;
  SphereScene().integrate_views(map, 16, map.labels().create());
  return map;
}

std::size_t encoded_bytes(const ChunkTotals& totals) {
  return 56 + 28 * std::size_t{totals.patches} + 16 * std::size_t{totals.vertices} +
         12 * std::size_t{totals.triangles};
}

using Place = std::array<float, 3>;

TEST(SavedSurfaceTest, IsTheMeshOfTheWholeMap) {
  const VoxelMap map = sphere_map();
  const Mesh whole = extract_mesh(map);
  std::map<Place, std::size_t> vertex_at;
  for (std::size_t v = 0; v < whole.vertices.size(); ++v)
    vertex_at[{whole.vertices[v].x(), whole.vertices[v].y(), whole.vertices[v].z()}] = v;
  const SavedSurface surface(sphere_map());
  std::size_t triangles = 0;
  surface.for_each_patch(all_space(), [&](const SurfacePatch& patch) {
    triangles += patch.mesh->triangles.size();
    for (std::size_t v = 0; v < patch.mesh->vertices.size(); ++v) {
      const Eigen::Vector3f& at = patch.mesh->vertices[v];
      const auto same = vertex_at.find({at.x(), at.y(), at.z()});
      ASSERT_NE(same, vertex_at.end());
      EXPECT_EQ(patch.mesh->labels[v], whole.labels[same->second]);
      EXPECT_EQ(patch.mesh->colors[v], whole.colors[same->second]);
      EXPECT_GT(patch.mesh->normals[v].dot(whole.normals[same->second]), 0.9f);
    }
  });
  EXPECT_EQ(triangles, whole.triangles.size());
  EXPECT_GT(surface.list(0).size(), 4u);
}

TEST(SavedSurfaceTest, HasLessAndLessDetail) {
  const SavedSurface surface(sphere_map());
  EXPECT_FALSE(surface.errors().empty()) << "makes all chunks";
  std::array<std::size_t, ServedSurface::kLevels> triangles{};
  for (int level = 0; level < ServedSurface::kLevels; ++level)
    for (const ChunkListing& chunk : surface.list(level)) {
      ASSERT_TRUE(chunk.totals);
      triangles[static_cast<std::size_t>(level)] += chunk.totals->triangles;
      const auto bytes = surface.encoded(level, chunk.index);
      ASSERT_TRUE(bytes);
      EXPECT_EQ(bytes->size(), encoded_bytes(*chunk.totals));
    }
  EXPECT_LT(triangles[1], triangles[0] / 2);
  EXPECT_LT(triangles[2], triangles[1] / 2);
  EXPECT_GT(triangles[2], 0u);
  EXPECT_FALSE(surface.encoded(0, {1000, 0, 0}));
}

TEST(SavedSurfaceTest, TellsWhatIsNewToWhoSawTheMapBefore) {
  const VoxelMap map = sphere_map();
  const Eigen::Vector3i chunk = ChunkGrid::chunk_of(map.block_index(0)), far(100, 0, 0);
  const BlockIndex before = chunk * ChunkGrid::kChunkBlocks + BlockIndex(1, 2, 3);
  const ShownBlocks shown = {{pack_index(chunk), {before}},
                             {pack_index(far), {far * ChunkGrid::kChunkBlocks}}};
  const SavedSurface surface(sphere_map(), {}, 8, shown);
  EXPECT_EQ(surface.version(), 8u);
  surface.errors();
  EXPECT_EQ(surface.list(0, 7).size(), SavedSurface(sphere_map()).list(0).size() + 1);
  EXPECT_TRUE(surface.list(0, 8).empty());
  const std::size_t anew = surface.encoded(0, chunk)->size();
  EXPECT_EQ(surface.encoded(0, chunk, 7)->size(), anew + 28) << "a block that lost its surface";
  EXPECT_EQ(surface.encoded(0, far, 7)->size(), encoded_bytes({1, 0, 0}));
}

class SavedSurfaceInParts : public MapFolder {};

TEST_F(SavedSurfaceInParts, IsTheSameHoweverManyAsk) {
  MapDocument document;
  document.map = sphere_map();
  document.depth_camera = {640, 480, 500, 500, 320, 240};
  const std::filesystem::path path = root_ / "sphere.ovimap";
  save_map(path, document);
  const SavedSurface whole(sphere_map());
  SavedSurfaceConfig config;
  config.kept_bytes = 0;
  const SavedSurface parts(std::move(load_map_by_tiles(path, 0).map), config);
  std::vector<std::future<void>> askers;
  for (int asker = 0; asker < 4; ++asker)
    askers.push_back(std::async(std::launch::async, [&] {
      for (const int level : {2, 0, 1})
        for (const ChunkListing& chunk : parts.list(level))
          EXPECT_EQ(*parts.encoded(level, chunk.index), *whole.encoded(level, chunk.index));
    }));
  for (auto& asker : askers) asker.get();
  EXPECT_EQ(parts.errors(), whole.errors());
}

}  // namespace
}  // namespace ovimap
