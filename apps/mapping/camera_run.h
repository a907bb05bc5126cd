// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/command/command.h"
#include "ovimap/pipeline/live/camera_feed.h"

namespace ovimap::apps {

/// A camera that is plugged in, which a live run maps.
class CameraRun {
 public:
  /// Opens the camera that `options.source` names, and makes its poses ones to be found. Throws
  /// Error as open_camera, and where the options are for recordings.
  explicit CameraRun(MappingOptions& options);

  FrameIntake& intake() { return intake_; }
  CameraFeed& feed() { return feed_; }
  /// After the run: whether the camera was there until its end; else one line says what happened.
  bool report_loss();

 private:
  const ProgramConfig config_;
  std::unique_ptr<RgbdCamera> camera_;
  FrameIntake intake_;
  CameraFeed feed_;
};

}  // namespace ovimap::apps
