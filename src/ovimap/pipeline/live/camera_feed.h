// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <thread>

#include "ovimap/frames/cameras/rgbd_camera.h"
#include "ovimap/pipeline/live/frame_intake.h"

namespace ovimap {

/// Hands what a camera sends to an intake, on a thread of its own, until the intake ends; a camera
/// that is gone ends it. Frames that find no room there are counted by it.
class CameraFeed {
 public:
  /// Both must outlive it. `quiet`: a camera that sends nothing for so long is gone.
  CameraFeed(RgbdCamera& camera, FrameIntake& intake,
             std::chrono::milliseconds quiet = std::chrono::seconds(5))
      : camera_(camera), intake_(intake), quiet_(quiet) {}
  ~CameraFeed() { stop(); }
  CameraFeed(const CameraFeed&) = delete;
  CameraFeed& operator=(const CameraFeed&) = delete;

  void start();
  /// Returns when the thread has ended.
  void stop();

  const RgbdCamera& camera() const { return camera_; }
  /// How the camera was lost, as "was unplugged"; empty: it was not. Asked after stop().
  const std::string& fault() const { return fault_; }

 private:
  void run(const std::stop_token& stop);

  RgbdCamera& camera_;
  FrameIntake& intake_;
  const std::chrono::milliseconds quiet_;
  std::string fault_;
  std::jthread thread_;
};

}  // namespace ovimap
