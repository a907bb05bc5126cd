// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "ovimap/track/places/keyframe.h"

namespace ovimap {

/// What keyframes together show from another pose, as a frame at the keyframes' level would be:
/// each pixel with depth is thrown into the new view (point splatting), the nearest surface wins,
/// and what shows it is averaged. What none of them saw stays unknown. So a place is known again
/// from where nobody stood before, and nothing hides behind what a single keyframe had in front of
/// it. `camera`: of the view. The keyframes' poses must agree with each other.
TrackLevel place_view(std::span<const Keyframe> places, const PinholeCamera& camera,
                      const Pose& world_from_camera);

}  // namespace ovimap
