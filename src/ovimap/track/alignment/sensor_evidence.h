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

/// What tracked frames say of how they were taken, beside from where. A focal length that is not
/// the camera's stretches what it sees sideways, differently from each pose, and leaves residuals
/// that no pose takes away: it is one more unknown in the normal equations of a frame, from which
/// the six of the pose are eliminated.
class SensorEvidence {
 public:
  /// Adds an aligned frame, by the points of one level.
  void add(const ReferenceLevel& reference, const TrackLevel& frame,
           const Pose& reference_from_frame, const FrameAlignmentConfig& config);

  /// The natural logarithm of the camera's focal length over the given one; nullopt where too few
  /// frames tell.
  std::optional<Estimate> log_focal_ratio() const;

 private:
  struct Part {
    double information = 0, score = 0;
  };
  std::vector<Part> parts_;  ///< by frame
};

}  // namespace ovimap
