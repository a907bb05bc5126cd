// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/places/keyframe.h"

namespace ovimap {

Keyframe make_keyframe(const TrackPyramid& pyramid, std::int64_t index,
                       const Pose& world_from_camera) {
  return {index, world_from_camera, place_code(pyramid), pyramid[kSurfaceLevel]};
}

TrackPyramid pyramid_of(const Keyframe& keyframe) {
  TrackPyramid pyramid(1);
  pyramid[0].camera = keyframe.image.camera;
  pyramid.push_back(keyframe.image);
  add_coarser_levels(pyramid);
  return pyramid;
}

bool KeyframeSpacing::far(const Pose& from, const Pose& to) const {
  const Pose step = from.inverse() * to;
  return step.translation().norm() >= step_m ||
         Eigen::AngleAxisd(step.linear()).angle() >= step_rad;
}

}  // namespace ovimap
