// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/track/alignment/alignment.h"
#include "ovimap/track/places/keyframe.h"

namespace ovimap {

struct TrackConfig {
  FrameAlignmentConfig alignment;
  // When a frame is believed to be where the alignment says.
  float min_overlap = 0.15f;      ///< share of the reference in sight
  float min_agreement = 0.6f;     ///< share of that on the reference's surface
  float min_correlation = 0.8f;   ///< of intensities, where there is texture
  float min_texture = 6.f;        ///< grey levels; less is none
  float min_depth_share = 0.05f;  ///< share of pixels with depth
  float max_step_m = 0.4f;        ///< between frames
  float max_step_rad = 0.6f;
  bool gyroscope = true;               ///< whether what one says is taken
  float gyroscope_sigma_rad = 0.005f;  ///< of a gyroscope's turn, per frame
  // When the map's surface is cast anew.
  float reference_overlap = 0.65f;  ///< share of the reference still in sight
  int reference_frames = 40;        ///< at the latest after so many
  // Places to be found again.
  KeyframeSpacing keyframes;
  int place_candidates = 4;
  float min_similarity = 0.5f;
  float relocated_agreement = 0.7f;  ///< what a found place must reach
  float relocated_correlation = 0.85f;
  float max_range_m = 8.f;  ///< how far the map's surface is cast
  int part_frames = 30;  ///< lost frames on end, with depth, that are mapped by themselves; 0: none
  // When the user is told that the focal length is not the camera's, or a time stamp wrong.
  float focal_off = 0.05f;    ///< share by which it is off
  float delay_frames = 0.7f;  ///< between colour and depth, or frames and given poses
  float sensor_sigmas = 5.f;  ///< standard errors of either
};
void list_fields(TrackConfig& config, ConfigFields& fields);

/// Whether a frame is where its alignment says; `lost`: it must agree better, for nothing but the
/// alignment speaks for the place.
bool believable(const AlignmentQuality& quality, const TrackConfig& config, bool lost);

}  // namespace ovimap
