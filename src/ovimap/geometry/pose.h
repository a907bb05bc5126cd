// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace ovimap {

/// A rigid transform named target_from_source: x_in_target = target_from_source * x_in_source.
using Pose = Eigen::Isometry3d;

/// What makes a 4x4 matrix no rigid transform: "not finite", "rotation not orthonormal",
/// "rotation is a reflection", "last row is not 0 0 0 1", "more than 10 km from the origin ..."
/// (maps are kept in single precision). Empty when it is one (tolerance 1e-3, as text files carry
/// few digits).
std::string pose_fault(const Eigen::Matrix4d& matrix);

/// The nearest rigid transform to a matrix without pose_fault: the rotation is re-orthonormalised.
Pose rigid_pose(const Eigen::Matrix4d& matrix);

/// The shortest turn that takes one direction to another. Here, because every source that asks
/// Eigen for it takes four seconds longer to compile: opposite directions need an SVD.
Eigen::Quaternionf shortest_turn(const Eigen::Vector3f& from, const Eigen::Vector3f& to);
Eigen::Quaterniond shortest_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace ovimap
