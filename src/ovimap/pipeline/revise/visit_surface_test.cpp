// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/visit_surface.h"

#include <gtest/gtest.h>

#include "ovimap/instance/instance_mesh.h"
#include "ovimap/map/voxels/label_slots.h"

namespace ovimap {
namespace {

constexpr InstanceId kChair = 4, kTable = 7;

/// Two square plates of surface, a thing each, seen in one frame.
class VisitSurface : public ::testing::Test {
 protected:
  VisitSurface() {
    for (auto* map : {&before_, &after_}) {
      const Label chair = map->map.labels().create(), table = map->map.labels().create();
      put_plate(*map, 0, chair);
      put_plate(*map, 40, table);
      for (const auto& [id, label] : {std::pair{kChair, chair}, std::pair{kTable, table}}) {
        InstanceSummary& instance = map->instances.emplace_back();
        instance.id = id;
        instance.super_points = {label};
      }
      measure_instances(map->map, map->instances);
      map->surfaces = sample_surfaces(map->map, map->instances);
      map->frames.resize(1);
      map->history.visits = {{"before", 0, 0}};
    }
    after_.frames.resize(3);
    after_.history.visits.push_back({"after", 1, 1});
  }

  /// From voxel x = `first` on, 24 voxels square, at z = 0.
  static void put_plate(MapDocument& map, int first, Label label) {
    for (int z = -3; z < 3; ++z)
      for (int y = 0; y < 24; ++y)
        for (int x = first; x < first + 24; ++x) {
          VoxelBlock& block =
              map.map.writable_block(map.map.find_or_create({x >> 3, y >> 3, z >> 3}));
          const int v = voxel_offset(x & 7, y & 7, z & 7);
          const auto at = static_cast<std::size_t>(v);
          block.tsdf[at] = static_cast<VoxelBlock::Tsdf>(3276 * (2 * z + 1));
          block.weight[at] = 1.f;
          if (z == -1 || z == 0) add_support(block, v, palette_position(block, label), 1);
        }
  }

  /// The visit sees the plate that begins there once more.
  void see_again(int first) {
    for (std::uint32_t slot = 0; slot < after_.map.block_count(); ++slot) {
      VoxelBlock& block = after_.map.writable_block(slot);
      for (int v = 0; v < kBlockVoxels; ++v) {
        const int x = block.index.x() * kBlockSide + (v & 7);
        if (x >= first && x < first + 24 && block.weight[static_cast<std::size_t>(v)] > 0.f)
          block.weight[static_cast<std::size_t>(v)] += 1.f;
      }
    }
  }

  std::size_t surface_points(const MapDocument& map, InstanceId id) {
    const auto found = map.surfaces.find(id);
    return found == map.surfaces.end() ? 0 : found->second.size();
  }

  MapDocument before_, after_;
};

TEST_F(VisitSurface, IsWhatTheVisitTouched) {
  ASSERT_GT(surface_points(after_, kChair), 50u);
  see_again(40);
  const MapDocument seen = seen_in_visit(before_, after_);
  ASSERT_EQ(seen.instances.size(), 1u);
  EXPECT_EQ(seen.instances[0].id, kTable);
  EXPECT_EQ(surface_points(seen, kChair), 0u);
  EXPECT_EQ(surface_points(seen, kTable), surface_points(after_, kTable));
  EXPECT_EQ(seen.frames.size(), 2u) << "the visit's own";
  EXPECT_LT(seen.map.block_count(), after_.map.block_count());
  for (std::uint32_t slot = 0; slot < seen.map.block_count(); ++slot)
    EXPECT_EQ(seen.map.block(slot).palette.size(), 1u) << "labels mean nothing without the map's";
}

TEST_F(VisitSurface, OfWhatLeftNothingRemains) {
  see_again(40);
  forget_remains(before_, seen_in_visit(before_, after_), {kChair}, after_);
  ASSERT_EQ(after_.instances.size(), 1u);
  EXPECT_EQ(after_.instances[0].id, kTable);
  EXPECT_EQ(surface_points(after_, kChair), 0u);
  const Mesh mesh = extract_instance_mesh(after_.map, after_.instances);
  for (const Eigen::Vector3f& vertex : mesh.vertices) EXPECT_GE(vertex.x(), 0.39f);
  EXPECT_FALSE(mesh.vertices.empty());
}

TEST_F(VisitSurface, WhatIsSeenStaysThoughItsLabelIsThatOfWhatLeft) {
  see_again(0);
  see_again(40);
  forget_remains(before_, seen_in_visit(before_, after_), {kChair}, after_);
  EXPECT_EQ(after_.instances.size(), 2u);
  EXPECT_GT(surface_points(after_, kChair), 50u);
}

TEST_F(VisitSurface, NothingGoesWhereNothingLeft) {
  const std::uint64_t hash = after_.map.content_hash();
  forget_remains(before_, seen_in_visit(before_, after_), {}, after_);
  EXPECT_EQ(after_.map.content_hash(), hash);
}

}  // namespace
}  // namespace ovimap
