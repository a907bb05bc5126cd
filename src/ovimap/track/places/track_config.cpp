// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/places/track_config.h"

#include "ovimap/base/config.h"

namespace ovimap {

void list_fields(TrackConfig& config, ConfigFields& fields) {
  list_fields(config.alignment, fields);
  fields.add("min_overlap", config.min_overlap, 0.f, 1.f,
             "least share of the reference in sight of a tracked frame");
  fields.add("min_agreement", config.min_agreement, 0.f, 1.f,
             "least share of a tracked frame's depth that lies on the map's surface");
  fields.add("min_correlation", config.min_correlation, -1.f, 1.f,
             "least correlation of a tracked frame's intensities with the reference's");
  fields.add("min_texture", config.min_texture, 0.f, 255.f,
             "standard deviation below which intensities say nothing, grey levels");
  fields.add("min_depth_share", config.min_depth_share, 0.f, 1.f,
             "least share of pixels with depth of a tracked frame");
  fields.add("max_step_m", config.max_step_m, 0.f, 100.f,
             "most that a camera moves between frames, metres");
  fields.add("max_step_rad", config.max_step_rad, 0.f, 3.2f,
             "most that a camera turns between frames, radians");
  fields.add("gyroscope", config.gyroscope, "whether a gyroscope's turns are predictions");
  fields.add("gyroscope_sigma_rad", config.gyroscope_sigma_rad, 1e-4f, 10.f,
             "standard deviation of a frame's turn as a gyroscope gives it, radians");
  fields.add("reference_overlap", config.reference_overlap, 0.f, 1.f,
             "the map's surface is cast anew when less of it is in sight");
  fields.add("reference_frames", config.reference_frames, 1, 10000,
             "the map's surface is cast anew at the latest after so many frames");
  fields.add("keyframe_step_m", config.keyframes.step_m, 0.01f, 100.f,
             "places that are remembered are so far apart, metres");
  fields.add("keyframe_step_rad", config.keyframes.step_rad, 0.01f, 3.2f,
             "or turned so far, radians");
  fields.add("place_candidates", config.place_candidates, 1, 100,
             "places that a lost frame is held against");
  fields.add("min_similarity", config.min_similarity, -1.f, 1.f,
             "least similarity of the code of a place to be held against");
  fields.add("relocated_agreement", config.relocated_agreement, 0.f, 1.f,
             "min_agreement of a frame that was lost");
  fields.add("relocated_correlation", config.relocated_correlation, -1.f, 1.f,
             "min_correlation of a frame that was lost");
  fields.add("max_range_m", config.max_range_m, 0.1f, 1000.f,
             "how far the map's surface is cast, metres");
  fields.add("part_frames", config.part_frames, 0, 1000000,
             "lost frames on end, with depth, that are mapped by themselves; 0: none");
  fields.add("focal_off", config.focal_off, 0.f, 10.f,
             "a focal length is doubted that seems to be off by a larger share");
  fields.add("delay_frames", config.delay_frames, 0.f, 1000.f,
             "time stamps are doubted that seem to be off by more, frames");
  fields.add("sensor_sigmas", config.sensor_sigmas, 0.f, 1000.f,
             "and either is as many standard errors");
}

bool believable(const AlignmentQuality& quality, const TrackConfig& config, bool lost) {
  const float agreement = lost ? config.relocated_agreement : config.min_agreement;
  const float correlation = lost ? config.relocated_correlation : config.min_correlation;
  return quality.overlap >= config.min_overlap && quality.agreement >= agreement &&
         (quality.texture < config.min_texture || quality.correlation >= correlation);
}

}  // namespace ovimap
