// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/consensus/super_point_shapes.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

/// A step up: a floor (label 1) that meets a wall (label 2) in an edge of the mesh, seen from
/// above.
Mesh floor_and_wall() {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {1.1f, 0, 1}, {1.1f, 1, 1}};
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {2, 4, 5}, {2, 5, 3}};
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {-1, 0, 0}, {-1, 0, 0}};
  mesh.colors = {{10, 10, 10}, {10, 10, 10}, {10, 10, 10},
                 {10, 10, 10}, {20, 30, 10}, {20, 30, 10}};
  mesh.labels = {1, 1, 1, 1, 2, 2};
  return mesh;
}

TEST(SuperPointShapes, SumUpTheVerticesOfEachLabel) {
  SuperPointShapes shapes;
  shapes.add(floor_and_wall());
  ASSERT_EQ(shapes.of.size(), 2u);
  const SuperPointShape& floor = shapes.of.at(1);
  EXPECT_EQ(floor.vertices, 4);
  EXPECT_EQ(floor.position_sum, Eigen::Vector3d(2, 2, 0));
  EXPECT_EQ(floor.normal_sum, Eigen::Vector3d(0, 0, 4));
  EXPECT_EQ(floor.color_sum, Eigen::Vector3d(40, 40, 40));
  EXPECT_EQ(floor.box.max(), Eigen::Vector3f(1, 1, 0));
  EXPECT_EQ(shapes.of.at(2).color_sum, Eigen::Vector3d(40, 60, 20));
}

TEST(SuperPointShapes, AFoldIsNegativeInACornerAndPositiveOverAnEdge) {
  SuperPointShapes corner;
  corner.add(floor_and_wall());
  const SuperPointBorder& border = corner.borders.at({1, 2});
  EXPECT_EQ(border.edges, 4) << "of the triangles; an edge between two triangles counts for both";
  EXPECT_LT(border.fold, 0);
  EXPECT_DOUBLE_EQ(border.color_step, 4 * 30);

  Mesh edge = floor_and_wall();
  for (Eigen::Vector3f& vertex : edge.vertices) vertex.z() = -vertex.z();
  for (std::size_t i = 4; i < 6; ++i) edge.normals[i] = {1, 0, 0};
  SuperPointShapes over;
  over.add(edge);
  EXPECT_GT(over.borders.at({1, 2}).fold, 0);
}

TEST(SuperPointShapes, WhatHasNoLabelIsNoNeighbour) {
  Mesh mesh = floor_and_wall();
  mesh.labels = {1, 1, 1, 1, 0, 0};
  SuperPointShapes shapes;
  shapes.add(mesh);
  EXPECT_EQ(shapes.of.size(), 1u);
  EXPECT_TRUE(shapes.borders.empty());
}

}  // namespace
}  // namespace ovimap
