// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "ovimap/segment/depth_surface.h"
#include "ovimap/track/alignment/normal_equations.h"
#include "ovimap/track/alignment/reference.h"

namespace ovimap {

class ConfigFields;

struct FrameAlignmentConfig {
  DepthNoiseConfig noise;           ///< of the sensor's depth
  float model_sigma_m = 0.003f;     ///< standard deviation of the map's surface
  float photometric_weight = 0.2f;  ///< of a pixel's intensity beside its depth; 0: depth alone
  float independent_share = 0.01f;  ///< of all residuals: neighbours err alike
  float prior_sigma_m = 0.03f;      ///< of the predicted motion, per frame
  float prior_sigma_rad = 0.05f;
  float degenerate_sigma_m = 0.02f;  ///< directions known less well are left to the prediction
  int max_iterations = 20;           ///< of a level, the coarsest; finer ones take fewer
};
void list_fields(FrameAlignmentConfig& config, ConfigFields& fields);

/// How well a frame agrees with a reference at a pose.
struct AlignmentQuality {
  double overlap = 0;      ///< share of the reference's points that the frame can see
  double agreement = 0;    ///< of those with depth in the frame, the share within its noise
  double correlation = 0;  ///< of intensities, -1 to 1; 0 without texture
  double texture = 0;      ///< standard deviation of the reference's intensities in sight
  double cost = 1e9;       ///< mean robust cost of a point; compares poses, not frames
};

/// Agrees so well that no other start need be tried.
bool beyond_doubt(const AlignmentQuality& quality);

struct Alignment {
  Pose reference_from_frame = Pose::Identity();
  Matrix6d information = Matrix6d::Zero();  ///< of the data alone: translation in metres, rotation
                                            ///< in radians, in the reference's camera frame
  int degenerate = 0;                       ///< directions that were left to the prediction
  AlignmentQuality quality;
};

/// Moves a frame until its depth lies on the reference's surface (point to plane, each residual
/// weighed by what noise in inverse depth makes of it) and its intensities are those of the
/// reference, from coarse to fine, with weights of Student's t for both. `predicted` is where it
/// starts, and what decides where the data do not. `finest`: the last level (0: all).
///
/// Deterministic for any number of threads: sums are made in pieces of fixed size and in order.
Alignment align(const Reference& reference, const TrackPyramid& frame, const Pose& predicted,
                const FrameAlignmentConfig& config, std::size_t finest = 0);

/// The same from the one of several starts that fits best at a coarse level, which is the
/// prediction as well. Where that leaves a doubt the others are tried, and the best result is
/// taken; nullopt where none shows enough of the reference.
std::optional<Alignment> align_best(const Reference& reference, const TrackPyramid& frame,
                                    const std::vector<Pose>& reference_from_frame,
                                    const FrameAlignmentConfig& config);

/// The quality at a pose, by the points of one level.
AlignmentQuality judge(const Reference& reference, const TrackPyramid& frame,
                       const Pose& reference_from_frame, const FrameAlignmentConfig& config,
                       std::size_t level);

}  // namespace ovimap
