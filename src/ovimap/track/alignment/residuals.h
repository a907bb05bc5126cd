// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/track/alignment/alignment.h"

namespace ovimap {

/// Residuals of one kind are this large, robustly; weights and costs are those of Student's t.
struct ResidualScale {
  float geometric = 3;       ///< in standard deviations of the noise model
  float photometric = 20;    ///< in grey levels
  float reach = 1;           ///< how much farther than a pixel's noise a surface may be off and be
                             ///< the same
  float gain = 1, bias = 0;  ///< reference intensity = gain * frame intensity + bias
};

/// Sums over points at one pose.
struct ResidualSums {
  Matrix6d h = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  double points = 0, seen = 0, measured = 0, agreeing = 0;
  double geometric_squares = 0, geometric_weights = 0;  ///< weighted squares of residuals; how many
  double photometric_squares = 0, photometric_count = 0;
  double cost = 0;  ///< without derivatives only
  double frame_sum = 0, frame_squares = 0, reference_sum = 0, reference_squares = 0, products = 0;

  ResidualSums& operator+=(const ResidualSums& other);
  /// The scale that the next pass should take.
  ResidualScale next_scale(const ResidualScale& present) const;
};

/// Residuals of a level's points and, if `derivatives`, the normal equations of the motion that is
/// to be made before reference_from_frame.
ResidualSums sum_residuals(const ReferenceLevel& reference, const TrackLevel& frame,
                           const Pose& reference_from_frame, const ResidualScale& scale,
                           const FrameAlignmentConfig& config, bool derivatives);

/// What a frame says of one point.
struct PointResidual {
  bool seen = false;      ///< projects into the frame
  bool measured = false;  ///< which has depth there
  bool near = false;      ///< of the surface, as far as one can tell
  bool textured = false;  ///< both have an intensity
  float distance_m = 0;   ///< of the frame's point off the reference's plane
  float sigma_m = 1;      ///< its standard deviation
  float intensity = 0;    ///< of the frame
  Eigen::Vector3f hit = Eigen::Vector3f::Zero();  ///< the frame's point, in the reference
};

/// The residuals of all points of a level, in their order.
std::vector<PointResidual> point_residuals(const ReferenceLevel& reference, const TrackLevel& frame,
                                           const Pose& reference_from_frame,
                                           const FrameAlignmentConfig& config, float reach);

}  // namespace ovimap
