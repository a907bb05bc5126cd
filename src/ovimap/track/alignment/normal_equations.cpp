// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/alignment/normal_equations.h"

#include <Eigen/Eigenvalues>

namespace ovimap {

Pose small_motion(const Vector6d& motion) {
  Pose pose = Pose::Identity();
  pose.translation() = motion.head<3>();
  const Eigen::Vector3d turn = motion.tail<3>();
  if (const double angle = turn.norm(); angle > 0)
    pose.linear() = Eigen::AngleAxisd(angle, turn / angle).matrix();
  return pose;
}

Vector6d motion_of(const Pose& pose) {
  const Eigen::AngleAxisd turn(pose.linear());
  Vector6d motion;
  motion << pose.translation(), turn.angle() * turn.axis();
  return motion;
}

MotionStep solve_step(const Matrix6d& h, const Vector6d& b, const MotionPrior& prior,
                      double lever_m, double min_information) {
  // With rotations in metres at the lever's end all six directions compare.
  Vector6d scale;
  scale << 1, 1, 1, 1 / lever_m, 1 / lever_m, 1 / lever_m;
  const Matrix6d data = scale.asDiagonal() * h * scale.asDiagonal();
  const Matrix6d belief = scale.asDiagonal() * prior.information * scale.asDiagonal();
  const Vector6d wanted = scale.cwiseInverse().asDiagonal() * prior.remaining;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> directions(data);
  MotionStep step;
  Matrix6d known = Matrix6d::Zero();  // projects on the directions that the data decide
  for (int i = 0; i < 6; ++i) {
    if (directions.eigenvalues()[i] < min_information) {
      ++step.degenerate;
      continue;
    }
    known += directions.eigenvectors().col(i) * directions.eigenvectors().col(i).transpose();
  }
  const Matrix6d total = known * data * known + belief + 1e-9 * Matrix6d::Identity();
  const Vector6d right = known * (scale.asDiagonal() * b) + belief * wanted;
  step.motion = scale.asDiagonal() * Vector6d(total.ldlt().solve(right));
  return step;
}

}  // namespace ovimap
