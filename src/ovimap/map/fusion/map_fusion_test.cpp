// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/fusion/map_fusion.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "ovimap/map/rays/sphere_fixture.h"
#include "ovimap/map/surface/mesh_extraction.h"
#include "ovimap/map/voxels/label_slots.h"

namespace ovimap {
namespace {

/// Views `first` to `last` of twelve around the sphere; `world_from_scene` moves everything.
void integrate_some(VoxelMap& map, int first, int last, Label label,
                    const Pose& world_from_scene = Pose::Identity()) {
  const SphereScene scene;
  const DepthImage depth = scene.depth();
  const Image<float> slope = scene.plane_slope();
  const RgbImage color(depth.width(), depth.height(), Rgb8{200, 100, 50});
  const IdImage ids(depth.width(), depth.height(), 1);
  for (int view = first; view < last; ++view) {
    const Pose pose = world_from_scene * scene.pose(2 * M_PI * view / 12);
    integrate(map, {.depth = depth,
                    .camera = scene.camera,
                    .world_from_camera = pose,
                    .color = &color,
                    .plane_slope = &slope,
                    .segment_ids = &ids,
                    .segment_labels = std::span(&label, 1)});
  }
}

TEST(FuseMap, TwoHalvesMakeTheWhole) {
  VoxelMap whole, left, right;
  for (VoxelMap* map : {&whole, &left, &right}) map->labels().create();
  integrate_some(whole, 0, 12, 1);
  integrate_some(left, 0, 7, 1);
  integrate_some(right, 7, 12, 1);
  const Label offset = append_labels(left, right.labels());
  EXPECT_EQ(offset, 1u);
  left.labels().merge(1, 1 + offset);
  fuse_map(left, right, Pose::Identity(), offset);
  for (std::uint32_t slot = 0; slot < whole.block_count(); ++slot) {
    const VoxelBlock& expected = whole.block(slot);
    const VoxelBlock* fused = left.find(expected.index);
    if (fused == nullptr) {  // made where it was never observed
      ASSERT_EQ(*std::max_element(expected.weight.begin(), expected.weight.end()), 0.f);
      continue;
    }
    for (int v = 0; v < kBlockVoxels; ++v) {
      const auto i = static_cast<std::size_t>(v);
      ASSERT_NEAR(fused->weight[i], expected.weight[i], 1e-3f * expected.weight[i]);
      ASSERT_TRUE(fused->weight[i] <= 0.f || fused->observed_rows >> i / kBlockSide & 1);
      ASSERT_NEAR(fused->tsdf[i], expected.tsdf[i], 20);  // rounded after every frame
      ASSERT_NEAR(unpack_color(fused->color[i])[0], unpack_color(expected.color[i])[0], 64);
      const LabelSupport a = voxel_labels(*fused, v, left.labels())[0],
                         b = voxel_labels(expected, v, whole.labels())[0];
      ASSERT_EQ(a.label, b.label);
      ASSERT_EQ(a.support, b.support);
    }
  }
}

TEST(FuseMap, AMapOfAnotherFrameFits) {
  Pose map_from_other(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  map_from_other.translation() = Eigen::Vector3d(0.333, -0.251, 0.117);
  VoxelMap map, other;
  map.labels().create();
  other.labels().create();
  integrate_some(map, 0, 6, 1);
  integrate_some(other, 6, 12, 1, map_from_other.inverse());
  fuse_map(map, other, map_from_other, append_labels(map, other.labels()));
  const Mesh mesh = extract_mesh(map);
  std::size_t seconds = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    ASSERT_NEAR(mesh.vertices[i].norm(), SphereScene::kRadius, 0.008f);
    seconds += mesh.labels[i] == 2;
    ASSERT_NEAR(mesh.colors[i][0], 200, 2);
  }
  VoxelMap half;
  half.labels().create();
  integrate_some(half, 0, 6, 1);
  EXPECT_GT(mesh.vertices.size(), extract_mesh(half).vertices.size() * 5 / 4);
  EXPECT_GT(seconds, mesh.vertices.size() / 6);
}

TEST(FuseMap, VoxelSizesMayDiffer) {
  VoxelMapConfig coarse;
  coarse.voxel_size_m = 0.017f;
  VoxelMap map, other(coarse);
  map.labels().create();
  other.labels().create();
  integrate_some(other, 0, 12, 1);
  fuse_map(map, other, Pose::Identity(), append_labels(map, other.labels()));
  const Mesh mesh = extract_mesh(map);
  EXPECT_GT(mesh.vertices.size(), 1000u);
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    ASSERT_NEAR(vertex.norm(), SphereScene::kRadius, 0.01f);
}

TEST(FuseMap, AnEmptyMapChangesNothing) {
  VoxelMap map;
  map.labels().create();
  integrate_some(map, 0, 3, 1);
  const std::uint64_t before = map.content_hash();
  fuse_map(map, VoxelMap(), Pose::Identity(), append_labels(map, LabelForest()));
  EXPECT_EQ(map.content_hash(), before);
}

}  // namespace
}  // namespace ovimap
