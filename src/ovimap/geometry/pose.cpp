// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/geometry/pose.h"

namespace ovimap {

std::string pose_fault(const Eigen::Matrix4d& matrix) {
  constexpr double kTolerance = 1e-3, kFarthest_m = 1e4;
  if (!matrix.allFinite()) return "not finite";
  if ((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > kTolerance)
    return "last row is not 0 0 0 1";
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const Eigen::Matrix3d gram = rotation.transpose() * rotation;
  if ((gram - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > kTolerance)
    return "rotation not orthonormal";
  if (rotation.determinant() < 0) return "rotation is a reflection";
  if (matrix.topRightCorner<3, 1>().cwiseAbs().maxCoeff() > kFarthest_m)
    return "more than 10 km from the origin; subtract an offset from all poses";
  return {};
}

Pose rigid_pose(const Eigen::Matrix4d& matrix) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(Eigen::Matrix3d(matrix.topLeftCorner<3, 3>()))
                      .normalized()
                      .toRotationMatrix();
  pose.translation() = matrix.topRightCorner<3, 1>();
  return pose;
}

Eigen::Quaternionf shortest_turn(const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
  return Eigen::Quaternionf::FromTwoVectors(from, to);
}

Eigen::Quaterniond shortest_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace ovimap
