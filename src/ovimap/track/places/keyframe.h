// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/track/alignment/reference.h"
#include "ovimap/track/places/place_code.h"

namespace ovimap {

/// How far two poses are apart, metres: one that looks another way counts as farther.
double place_distance(const Pose& from, const Pose& to);

/// A frame that stands for a place.
struct Keyframe {
  std::int64_t index = 0;  ///< of the frame in its source
  Pose world_from_camera = Pose::Identity();
  PlaceCode code;
  TrackLevel image;  ///< the surface's level
};

Keyframe make_keyframe(const TrackPyramid& pyramid, std::int64_t index,
                       const Pose& world_from_camera);

/// The levels that a keyframe has: its finest is empty.
TrackPyramid pyramid_of(const Keyframe& keyframe);

/// The keyframes nearest to a pose, at most `count`, the nearest first.
std::vector<Keyframe> nearest_keyframes(const std::vector<Keyframe>& keyframes,
                                        const Pose& world_from_camera, std::size_t count);

/// Whether the camera went far enough from a keyframe for another one.
struct KeyframeSpacing {
  float step_m = 0.25f, step_rad = 0.26f;
  bool far(const Pose& from, const Pose& to) const;
};

}  // namespace ovimap
