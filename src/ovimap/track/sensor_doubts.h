// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/track/tracker.h"

namespace ovimap {

/// How many frames later than its frame the poses that came with frames were taken: by how far the
/// turns that they make must be shifted to be those of the tracked camera (the least mean square;
/// between frames a parabola). Both are turns of one camera, so neither world matters, and drift
/// hardly does. nullopt where too little is known or no shift explains the turns much better than
/// none.
std::optional<double> pose_delay(const std::vector<TrackedFrame>& log);

/// What tracking says against the recording's camera or its time stamps, a sentence each.
std::vector<std::string> sensor_doubts(const Tracker& tracker);

}  // namespace ovimap
