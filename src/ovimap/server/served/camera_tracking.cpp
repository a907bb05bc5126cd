// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/served/camera_tracking.h"

#include <array>

#include "ovimap/base/error.h"

namespace ovimap {

const char* camera_state_name(CameraState state) {
  constexpr std::array kNames = {"given", "tracked", "lost"};
  return kNames[static_cast<std::size_t>(state)];
}

std::string tracking_json(const CameraTracking& tracking) {
  std::string pose;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      pose += concat(pose.empty() ? "" : ",", tracking.world_from_camera.matrix()(row, column));
  return concat("{\"state\":\"", camera_state_name(tracking.state),
                "\",\"frames_lost\":", tracking.frames_lost, ",\"loops\":", tracking.loops,
                ",\"world_from_camera\":[", pose, "]}");
}

}  // namespace ovimap
