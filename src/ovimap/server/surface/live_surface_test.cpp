// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/surface/live_surface.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

std::shared_ptr<Mesh> triangle_at(float x) {
  Mesh mesh;
  mesh.vertices = {{x, 0.01f, 0.01f}, {x + 0.01f, 0.01f, 0.01f}, {x, 0.02f, 0.01f}};
  mesh.labels = {1, 1, 1};
  mesh.triangles = {{0, 1, 2}};
  return std::make_shared<Mesh>(mesh);
}

TEST(LiveSurfaceTest, ChangesPatchesAndTellsWhichWereLost) {
  LiveSurface surface(ChunkGrid{0.01f});
  EXPECT_EQ(surface.version(), 0u);
  surface.update({{{0, 0, 0}, 0, triangle_at(0.01f)}, {{20, 0, 0}, 0, triangle_at(1.61f)}});
  EXPECT_EQ(surface.version(), 1u);
  EXPECT_EQ(surface.list(0).size(), 2u);
  surface.update({{{1, 0, 0}, 0, triangle_at(0.09f)}, {{0, 0, 0}, 0, nullptr}});
  ASSERT_EQ(surface.list(0, 1).size(), 1u);
  EXPECT_EQ(surface.list(0, 1)[0].totals->patches, 2u)
      << "a lost one is said, so that clients drop it";
  EXPECT_EQ(surface.list(0, 1)[0].totals->triangles, 1u);
  ASSERT_TRUE(surface.encoded(0, {0, 0, 0}));
  EXPECT_LT(surface.encoded(0, {0, 0, 0}, 2)->size(), surface.encoded(0, {0, 0, 0}, 1)->size());
  EXPECT_FALSE(surface.encoded(0, {5, 0, 0}));
}

TEST(LiveSurfaceTest, HasOneLevel) {
  LiveSurface surface(ChunkGrid{0.01f});
  surface.update({{{0, 0, 0}, 0, triangle_at(0.01f)}});
  for (const int level : {1, 2}) {
    EXPECT_TRUE(surface.list(level).empty());
    EXPECT_FALSE(surface.encoded(level, {0, 0, 0}));
  }
}

TEST(LiveSurfaceTest, ChunksAreOrderedByIndex) {
  LiveSurface surface(ChunkGrid{0.01f});
  for (const int x : {40, -20, 0, 20}) {
    const float at_m = 0.08f * static_cast<float>(x) + 0.01f;
    surface.update({{{x, 0, 0}, 0, triangle_at(at_m)}});
  }
  const auto list = surface.list(0);
  ASSERT_EQ(list.size(), 4u);
  for (std::size_t i = 1; i < list.size(); ++i)
    EXPECT_LT(pack_index(list[i - 1].index), pack_index(list[i].index));
}

TEST(LiveSurfaceTest, PatchesKnowHowWellTheirBlockIsKnown) {
  LiveSurface surface(ChunkGrid{0.01f});
  EXPECT_TRUE(surface.errors().empty());
  const BlockIndex block(3, 0, 0);
  surface.update({{block, 0, triangle_at(0.25f), 7}});
  surface.update({{block, 0, triangle_at(0.26f), 3}});
  EXPECT_EQ(surface.errors(), (BlockErrors{{pack_index(block), 3}}));
}

TEST(LiveSurfaceTest, GivesWhatMeetsABox) {
  LiveSurface surface(ChunkGrid{0.01f});
  surface.update({{{0, 0, 0}, 0, triangle_at(0.01f)}, {{40, 0, 0}, 0, triangle_at(3.21f)}});
  const auto patches_in = [&](const Eigen::AlignedBox3f& box) {
    std::size_t count = 0;
    surface.for_each_patch(box, [&](const SurfacePatch&) { ++count; });
    return count;
  };
  EXPECT_EQ(patches_in(all_space()), 2u);
  EXPECT_EQ(patches_in({Eigen::Vector3f(3.f, 0.f, 0.f), Eigen::Vector3f(3.3f, 1.f, 1.f)}), 1u);
  EXPECT_EQ(patches_in({Eigen::Vector3f(9.f, 0.f, 0.f), Eigen::Vector3f(9.3f, 1.f, 1.f)}), 0u);
  EXPECT_EQ(surface.blocks().size(), 2u);
}

}  // namespace
}  // namespace ovimap
