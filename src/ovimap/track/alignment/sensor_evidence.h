// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "ovimap/track/alignment/alignment.h"

namespace ovimap {

/// A figure and its standard error, from how much frames differ about it.
struct Estimate {
  double value = 0, sigma = 0;
  bool beyond(double least, double sigmas) const {
    return std::fabs(value) > least && std::fabs(value) > sigmas * sigma;
  }
};

/// One unknown of the camera, by what each frame says of it alone.
class UnknownEvidence {
 public:
  void add(double information, double score);
  /// nullopt where too few frames tell.
  std::optional<Estimate> estimate() const;

 private:
  struct Part {
    double information = 0, score = 0;
  };
  std::vector<Part> parts_;  ///< by frame
};

/// What tracked frames say of how they were taken, beside from where. A focal length that is not
/// the camera's stretches what it sees sideways, differently from each pose; colour of another
/// moment than depth shows the scene from another pose than depth does, wherever the camera moves
/// otherwise than it did at the reference. Both leave residuals that no pose takes away: each is
/// one more unknown in the normal equations of a frame, from which the six of the pose are
/// eliminated.
class SensorEvidence {
 public:
  /// Adds an aligned frame, by the points of one level. `motion_change`: the camera's motion at the
  /// frame less that at the reference, from frame to frame, in the reference's camera frame (metres
  /// and radians); nullopt: not known, and nothing is learnt of the delay.
  void add(const ReferenceLevel& reference, const TrackLevel& frame,
           const Pose& reference_from_frame, const std::optional<Vector6d>& motion_change,
           const FrameAlignmentConfig& config);

  /// The natural logarithm of the camera's focal length over the given one.
  std::optional<Estimate> log_focal_ratio() const { return focal_.estimate(); }
  /// How much later than depth colour was taken, in frames.
  std::optional<Estimate> color_delay() const { return delay_.estimate(); }

 private:
  UnknownEvidence focal_, delay_;
};

}  // namespace ovimap
