// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/fusion/past_evidence.h"

#include <gtest/gtest.h>

#include "ovimap/map/voxels/label_slots.h"

namespace ovimap {
namespace {

TEST(PastEvidence, CountsForNoMoreThanItMay) {
  VoxelMap map;
  VoxelBlock& block = map.writable_block(map.find_or_create({0, 0, 0}));
  const Label table = map.labels().create(), cup = map.labels().create();
  for (const auto& [voxel, looks] : {std::pair{3, 40}, std::pair{4, 1}}) {
    block.weight[static_cast<std::size_t>(voxel)] = static_cast<float>(3 * looks);
    block.tsdf[static_cast<std::size_t>(voxel)] = 500;
    for (int i = 0; i < looks; ++i) add_support(block, voxel, palette_position(block, table), 1);
  }
  for (int i = 0; i < 30; ++i) add_support(block, 3, palette_position(block, cup), 1);

  discount_past(map, {.most_weight = 4.f, .most_support = 4});

  EXPECT_EQ(block.weight[3], 4.f);
  EXPECT_EQ(block.weight[4], 3.f) << "no more than what it had";
  EXPECT_EQ(block.tsdf[3], 500) << "where the surface is stays";
  EXPECT_EQ(block.weight[5], 0.f);
  const VoxelLabels labels = voxel_labels(block, 3, map.labels());
  EXPECT_EQ(labels[0].label, table);
  EXPECT_EQ(labels[0].support, 4u);
  EXPECT_EQ(labels[1].label, cup);
  EXPECT_EQ(labels[1].support, 3u) << "its share of it";
  EXPECT_EQ(voxel_labels(block, 4, map.labels())[0].support, 1u);
}

}  // namespace
}  // namespace ovimap
