// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ovimap/track/places/keyframe.h"

namespace ovimap {

/// A pose that was corrected. `at` says when it was taken: a frame's index, or its time in seconds.
struct MovedPose {
  double at = 0;
  Pose before = Pose::Identity(), after = Pose::Identity();
};

/// What became of keyframes, by their index.
std::vector<MovedPose> moved_keyframes(const std::vector<Keyframe>& keyframes,
                                       const std::vector<Pose>& corrected);

/// Part of the way from one pose to another, `share` 0 to 1.
Pose pose_between(const Pose& first, const Pose& second, double share);

/// Moves poses as those around them moved, in proportion to when they were taken; before the first
/// and after the last, as that one did. `at[i]`: when poses[i] was taken; `moves`, in that order,
/// may not be empty.
std::vector<Pose> follow(const std::vector<Pose>& poses, const std::vector<double>& at,
                         const std::vector<MovedPose>& moves);

}  // namespace ovimap
