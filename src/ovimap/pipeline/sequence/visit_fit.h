// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/map/fusion/past_evidence.h"
#include "ovimap/map/voxels/voxel_map.h"
#include "ovimap/pipeline/alignment/map_alignment.h"
#include "ovimap/track/places/track_config.h"

namespace ovimap {

/// When a recording's poses are taken to be in a map's world frame.
struct VisitFitConfig {
  bool enabled = true;
  int frames = 16;               ///< of the recording, evenly spread, are held against the map
  float least_share = 0.2f;      ///< of a frame must see surface of the map for it to count
  float most_offset_m = 0.015f;  ///< a quarter of the frames may be further off
  float most_turn_rad = 0.0175f;
  float least_agreement = 0.5f;  ///< share of what is seen that must lie on the map's surface
  // Where nothing places it.
  int object_frames = 150;  ///< are mapped by themselves, to find its place by objects; 0: none
  AlignmentConfig alignment;
  PastEvidenceConfig past;  ///< of what the map has, when it is gone on with
};
void list_fields(VisitFitConfig& config, ConfigFields& fields);

/// How a recording lies to a map.
struct VisitFit {
  int compared = 0;     ///< frames that see the map
  double offset_m = 0;  ///< three quarters of them lie nearer than this to where the map says
  double turn_rad = 0;
  double agreement = 0;  ///< median share of what they see that lies on the map's surface then
  Pose map_from_recording = Pose::Identity();  ///< what most of them say
};

/// Aligns frames of a recording to a map's surface, by depth alone and each by itself, from the
/// poses that they come with. What moved since counts little (the alignment is robust), what the
/// map does not have not at all. The references must outlive it.
class VisitFitter {
 public:
  VisitFitter(const VoxelMap& map, const TrackConfig& track, const VisitFitConfig& config)
      : map_(map), track_(track), config_(config) {}

  /// A frame without a pose is passed over.
  void add(const Frame& frame);
  VisitFit fit() const;

 private:
  const VoxelMap& map_;
  const TrackConfig& track_;
  const VisitFitConfig& config_;
  std::vector<double> offsets_m_, turns_rad_, agreements_;
  std::vector<Pose> given_, moves_;  ///< poses of frames that see the map, and map_from_recording
                                     ///< as each of them says
};

/// The same of `config.frames` of the recording at `positions`. Frames that cannot be read are
/// passed over.
VisitFit fit_visit(const VoxelMap& map, const FrameSource& source,
                   const std::vector<std::int64_t>& positions, const TrackConfig& track,
                   const VisitFitConfig& config);

/// The motion of these that moves the recording's cameras least from where the others move them.
/// Turns count as far as they move what a camera sees a metre before it. Identity where there are
/// none.
Pose middle_motion(const std::vector<Pose>& world_from_camera, const std::vector<Pose>& moves);

/// What speaks against going on with the map, in words; empty when nothing does.
std::string misfit(const VisitFit& fit, const VisitFitConfig& config);

}  // namespace ovimap
