// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/places/keyframe.h"

#include <algorithm>

namespace ovimap {

namespace {

constexpr double kMetresPerRadian = 1.5;

}  // namespace

double place_distance(const Pose& from, const Pose& to) {
  const Pose between = from.inverse() * to;
  return between.translation().norm() +
         kMetresPerRadian * Eigen::AngleAxisd(between.linear()).angle();
}

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

std::vector<Keyframe> nearest_keyframes(const std::vector<Keyframe>& keyframes,
                                        const Pose& world_from_camera, std::size_t count) {
  std::vector<std::pair<double, std::size_t>> ranked;
  for (std::size_t i = 0; i < keyframes.size(); ++i)
    ranked.emplace_back(place_distance(world_from_camera, keyframes[i].world_from_camera), i);
  std::sort(ranked.begin(), ranked.end());
  std::vector<Keyframe> nearest;
  for (std::size_t i = 0; i < std::min(count, ranked.size()); ++i)
    nearest.push_back(keyframes[ranked[i].second]);
  return nearest;
}

bool KeyframeSpacing::far(const Pose& from, const Pose& to) const {
  const Pose step = from.inverse() * to;
  return step.translation().norm() >= step_m ||
         Eigen::AngleAxisd(step.linear()).angle() >= step_rad;
}

}  // namespace ovimap
