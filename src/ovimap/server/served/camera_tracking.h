// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "ovimap/geometry/pose.h"

namespace ovimap {

enum class CameraState {
  kGiven,    ///< its poses come from elsewhere
  kTracked,  ///< where it is, the map tells
  kLost,     ///< nobody knows where it is
};
const char* camera_state_name(CameraState state);  ///< "given", "tracked", "lost"

/// How the camera of a map that is being made is followed.
struct CameraTracking {
  CameraState state = CameraState::kGiven;
  Pose world_from_camera = Pose::Identity();  ///< where it was tracked last
  std::int64_t frames_lost = 0;               ///< since then
  std::size_t loops = 0;                      ///< that were closed when the map was completed
};

/// The same as JSON: "state", "frames_lost", "loops", "world_from_camera" (12 numbers, row by row).
std::string tracking_json(const CameraTracking& tracking);

}  // namespace ovimap
