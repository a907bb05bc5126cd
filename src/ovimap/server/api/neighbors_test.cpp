// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/api/neighbors.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

SearchObject box_object(InstanceId id, const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
  return {id, Eigen::AlignedBox3f(low, high), (low + high) / 2, 100, ""};
}

TEST(NeighborsTest, SaysWhatIsNearAndHow) {
  const SearchIndex index({box_object(1, {0.4f, 0.4f, 0.75f}, {0.5f, 0.5f, 0.85f}),  // a mug
                           box_object(2, {0, 0, 0}, {1, 1, 0.75f}),                  // its table
                           box_object(3, {1.2f, 0, 0}, {1.7f, 0.5f, 0.9f}),          // a chair
                           box_object(4, {9, 9, 0}, {10, 10, 1})},                   // far away
                          Embeddings::Zero(4, 2));
  const QueryScene scene = scene_of_boxes(index, Eigen::Vector3f::UnitZ());
  const auto of_mug = neighbors_of(index, scene, 0, {});
  ASSERT_EQ(of_mug.size(), 2u);
  EXPECT_EQ(of_mug[0].id, 2u);
  EXPECT_EQ(of_mug[0].relation, "on");
  EXPECT_NE(of_mug[0].evidence.find("#2"), std::string::npos);
  EXPECT_EQ(of_mug[1].id, 3u);
  EXPECT_EQ(of_mug[1].relation, "near");
  EXPECT_TRUE(neighbors_of(index, scene, 3, {}).empty());
  EXPECT_EQ(neighbors_of(index, scene, 0, {}, 1).size(), 1u);
}

}  // namespace
}  // namespace ovimap
