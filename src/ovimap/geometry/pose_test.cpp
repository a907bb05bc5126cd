// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/geometry/pose.h"

#include <limits>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(PoseFault, AcceptsARigidTransformWithFewDigits) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  matrix(0, 0) += 1e-4;
  EXPECT_EQ(pose_fault(matrix), "");
  const Eigen::Matrix3d rotation = rigid_pose(matrix).linear();
  EXPECT_TRUE((rotation.transpose() * rotation).isIdentity(1e-12));
}

TEST(PoseFault, NamesEachFault) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix(0, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(pose_fault(matrix), "not finite");
  matrix = Eigen::Matrix4d::Identity();
  matrix(0, 0) = 1.5;
  EXPECT_EQ(pose_fault(matrix), "rotation not orthonormal");
  matrix = Eigen::Matrix4d::Identity();
  matrix(2, 2) = -1;
  EXPECT_EQ(pose_fault(matrix), "rotation is a reflection");
  matrix = Eigen::Matrix4d::Identity();
  matrix(1, 3) = 5e6;
  EXPECT_NE(pose_fault(matrix).find("10 km"), std::string::npos);
  matrix = Eigen::Matrix4d::Identity();
  matrix(3, 0) = 1;
  EXPECT_EQ(pose_fault(matrix), "last row is not 0 0 0 1");
}

TEST(ShortestTurn, TakesOneDirectionToTheOther) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ(), slanting(1, -2, 0.5);
  EXPECT_TRUE((shortest_turn(slanting, z) * slanting.normalized()).isApprox(z, 1e-12));
  EXPECT_TRUE((shortest_turn(z, Eigen::Vector3d(-z)) * z).isApprox(-z, 1e-12));  // by any axis
  const Eigen::Vector3f y = Eigen::Vector3f::UnitY();
  EXPECT_TRUE(shortest_turn(y, y).isApprox(Eigen::Quaternionf::Identity()));
}

}  // namespace
}  // namespace ovimap
