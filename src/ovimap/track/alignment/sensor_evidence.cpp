// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/alignment/sensor_evidence.h"

#include <cmath>

#include <Eigen/Cholesky>

#include "ovimap/track/alignment/residuals.h"

namespace ovimap {

namespace {

constexpr std::size_t kFewestFrames = 5;  // whose scatter says anything
constexpr double kSensorFreedom = 5;      // degrees of freedom of Student's t, as of residuals

constexpr int kFocal = 6, kDelay = 7;  // after the six unknowns of the pose
using Row = Eigen::Matrix<double, 8, 1>;

/// Normal equations of a pose's six unknowns, the logarithm of the focal length and the delay.
struct Sums {
  Eigen::Matrix<double, 8, 8> h = Eigen::Matrix<double, 8, 8>::Zero();
  Row b = Row::Zero();
  void add(const Row& j, double residual, double emphasis) {
    const double weight = emphasis * (kSensorFreedom + 1) / (kSensorFreedom + residual * residual);
    h += weight * j * j.transpose();
    b -= weight * residual * j;
  }
};

/// Both the frame's point and the surface, which was seen by the same camera, move sideways when
/// the focal length grows: towards the optical axis of each.
Row geometric_row(const ReferencePoint& point, const PointResidual& at,
                  const Pose& reference_from_frame) {
  const Eigen::Vector3d normal = point.normal.cast<double>(), hit = at.hit.cast<double>(),
                        place = point.point.cast<double>();
  const Eigen::Vector3d in_frame = reference_from_frame.inverse() * hit;
  const Eigen::Vector3d moves =
      reference_from_frame.linear() * Eigen::Vector3d(-in_frame.x(), -in_frame.y(), 0) +
      Eigen::Vector3d(place.x(), place.y(), 0);
  Row row;
  row << normal, hit.cross(normal), normal.dot(moves), 0;
  return row;
}

/// Derivatives of the frame's intensity where a point projects. Colour that comes a frame late
/// shows the scene from a pose that is `motion_change` farther on.
Row photometric_row(const ReferencePoint& point, const PinholeCamera& camera,
                    const Pose& reference_from_frame, const Vector6d& motion_change) {
  const Eigen::Vector3d place = point.point.cast<double>();
  const double inverse = 1 / place.z(), du = static_cast<double>(point.gradient.x() * camera.fx),
               dv = static_cast<double>(point.gradient.y() * camera.fy);
  const Eigen::Vector3d by_point(du * inverse, dv * inverse,
                                 -(du * place.x() + dv * place.y()) * inverse * inverse);
  Vector6d motion;
  motion << -by_point, -place.cross(by_point);
  // What the point's own sideways motion does, and the frame's larger picture of it.
  const Eigen::Vector3d seen = reference_from_frame.inverse() * place;
  const Eigen::Vector3d growth =
      reference_from_frame.linear() * Eigen::Vector3d(seen.x(), seen.y(), 0);
  const double focal = by_point.dot(growth - Eigen::Vector3d(place.x(), place.y(), 0));
  Row row;
  row << motion, focal, motion.dot(motion_change);
  return row;
}

Sums sums_of(const ReferenceLevel& reference, const TrackLevel& frame,
             const Pose& reference_from_frame, const Vector6d& motion_change,
             const ResidualScale& scale, const FrameAlignmentConfig& config) {
  const std::vector<PointResidual> residuals =
      point_residuals(reference, frame, reference_from_frame, config, scale.reach);
  Sums sums;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const ReferencePoint point = reference.points[i];
    const PointResidual& at = residuals[i];
    if (at.near) {
      const double unit = static_cast<double>(at.sigma_m * scale.geometric);
      sums.add(geometric_row(point, at, reference_from_frame) / unit,
               static_cast<double>(at.distance_m) / unit, 1);
    }
    if (!at.textured || (at.measured && !at.near)) continue;
    const auto unit = static_cast<double>(scale.photometric);
    const double off =
        static_cast<double>(scale.gain * at.intensity + scale.bias - point.intensity) / unit;
    sums.add(photometric_row(point, reference.camera, reference_from_frame, motion_change) / unit,
             off, static_cast<double>(config.photometric_weight));
  }
  return sums;
}

/// Adds what a frame says of one unknown where the pose is whatever fits best.
void learn(const Sums& sums, int unknown, UnknownEvidence& evidence) {
  // A little of each direction is known beforehand, so that one that is not seen is no division by
  // 0.
  const Eigen::LDLT<Matrix6d> pose(sums.h.topLeftCorner<6, 6>() + Matrix6d::Identity());
  const Vector6d shared = sums.h.col(unknown).head<6>(), solved = pose.solve(shared);
  const double information = sums.h(unknown, unknown) - shared.dot(solved);
  if (information > 0) evidence.add(information, sums.b[unknown] - solved.dot(sums.b.head<6>()));
}

}  // namespace

void UnknownEvidence::add(double information, double score) {
  parts_.push_back({information, score});
}

std::optional<Estimate> UnknownEvidence::estimate() const {
  if (parts_.size() < kFewestFrames) return std::nullopt;
  double information = 0, score = 0;
  for (const Part& part : parts_) information += part.information, score += part.score;
  Estimate estimate{score / information, 0};
  double squares = 0;
  for (const Part& part : parts_) {
    const double off = part.score - part.information * estimate.value;
    squares += off * off;
  }
  estimate.sigma = std::sqrt(squares) / information;
  return estimate;
}

void SensorEvidence::add(const ReferenceLevel& reference, const TrackLevel& frame,
                         const Pose& reference_from_frame,
                         const std::optional<Vector6d>& motion_change,
                         const FrameAlignmentConfig& config) {
  ResidualScale scale;
  scale =
      sum_residuals(reference, frame, reference_from_frame, scale, config, false).next_scale(scale);
  const Sums sums = sums_of(reference, frame, reference_from_frame,
                            motion_change.value_or(Vector6d::Zero()), scale, config);
  learn(sums, kFocal, focal_);
  if (motion_change) learn(sums, kDelay, delay_);
}

}  // namespace ovimap
