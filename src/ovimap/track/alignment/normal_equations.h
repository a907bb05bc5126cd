// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "ovimap/geometry/pose.h"

namespace ovimap {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// exp of a small motion (translation, rotation vector): a pose that moves points by
/// translation + rotation x point to first order.
Pose small_motion(const Vector6d& motion);
/// Its inverse: translation and rotation vector of a pose.
Vector6d motion_of(const Pose& pose);

/// The step that minimises step' H step / 2 - step' b together with the prior.
struct MotionStep {
  Vector6d motion;
  int degenerate = 0;
};

/// A quadratic prior on the motion that is still to be made.
struct MotionPrior {
  Matrix6d information = Matrix6d::Zero();
  Vector6d remaining = Vector6d::Zero();  ///< from the present pose to the predicted one
};

/// Solves H step = b with the prior. Directions in which the data know less than `min_information`
/// (eigenvalues of H, rotations scaled by `lever_m` to metres) take the prior's step alone.
MotionStep solve_step(const Matrix6d& h, const Vector6d& b, const MotionPrior& prior,
                      double lever_m, double min_information);

}  // namespace ovimap
