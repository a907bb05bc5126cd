// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/track/alignment/residuals.h"

namespace ovimap {

/// sum_residuals as the method says it: one point after another in double precision, derivatives by
/// trying out small motions of the frame. For tests.
inline ResidualSums plain_sum_residuals(const ReferenceLevel& reference, const TrackLevel& frame,
                                        const Pose& reference_from_frame,
                                        const ResidualScale& scale,
                                        const FrameAlignmentConfig& config) {
  constexpr double kTry = 1e-3, kFreedom = 5;
  const Eigen::Isometry3f forth = reference_from_frame.cast<float>();
  const Eigen::Isometry3f back = reference_from_frame.inverse().cast<float>();
  const auto weight = [](double r) { return (kFreedom + 1) / (kFreedom + r * r); };
  const auto tried = [](int axis, double by) {
    Vector6d motion = Vector6d::Zero();
    motion[axis] = by;
    return small_motion(motion);
  };
  ResidualSums sums;
  for (const ReferencePoint& point : reference.points) {
    const PointResidual at = residual_of(point, frame, forth, back, config, scale.reach);
    sums.points += 1, sums.seen += at.seen, sums.measured += at.measured;
    const Eigen::Vector3d normal = point.normal.cast<double>(), place = point.point.cast<double>();
    if (at.near) {
      const double unit = at.sigma_m * scale.geometric, r = at.distance_m / unit;
      Vector6d j;
      for (int axis = 0; axis < 6; ++axis) {
        const auto off = [&](double by) {
          return normal.dot(tried(axis, by) * at.hit.cast<double>() - place) / unit;
        };
        j[axis] = (off(kTry) - off(-kTry)) / (2 * kTry);
      }
      sums.h += weight(r) * j * j.transpose();
      sums.b -= weight(r) * r * j;
    }
    if (!at.textured || (at.measured && !at.near)) continue;
    // Where the point appears in the reference when the frame moves: its intensity changes by the
    // gradient there.
    const double r = (scale.gain * at.intensity + scale.bias - point.intensity) / scale.photometric;
    const PinholeCamera& camera = reference.camera;
    const auto pixel = [&](int axis, double by) {
      const Eigen::Vector3d moved = tried(axis, by).inverse() * place;
      return Eigen::Vector2d(camera.fx * moved.x() / moved.z(), camera.fy * moved.y() / moved.z());
    };
    Vector6d j;
    for (int axis = 0; axis < 6; ++axis)
      j[axis] = point.gradient.cast<double>().dot(pixel(axis, kTry) - pixel(axis, -kTry)) /
                (2 * kTry) / scale.photometric;
    sums.h += config.photometric_weight * weight(r) * j * j.transpose();
    sums.b -= config.photometric_weight * weight(r) * r * j;
  }
  return sums;
}

}  // namespace ovimap
