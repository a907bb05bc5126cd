// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/live/camera_feed.h"

#include "ovimap/base/error.h"
#include "ovimap/pipeline/live/look_again.h"

namespace ovimap {

void CameraFeed::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void CameraFeed::stop() {
  thread_ = {};
}

void CameraFeed::run(const std::stop_token& stop) {
  auto last = std::chrono::steady_clock::now();
  while (!stop.stop_requested() && fault_.empty()) {
    CameraRead read = camera_.next(kLook);
    const auto now = std::chrono::steady_clock::now();
    if (read.frame) {
      last = now;
      const FrameIntake::Answer answer = intake_.offer(std::move(*read.frame));
      if (answer == FrameIntake::Answer::kEnded) return;
      if (answer == FrameIntake::Answer::kOtherCamera)
        fault_ = "has another calibration than the camera that the map was begun with";
    } else if (!read.fault.empty()) {
      fault_ = std::move(read.fault);
    } else if (now - last > quiet_) {
      fault_ = concat("has sent no image for ", quiet_.count() / 1000., " s");
    }
  }
  intake_.finish();
}

}  // namespace ovimap
