// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "camera_run.h"

namespace ovimap::apps {

namespace {

/// Throws Error for what a camera does not have.
void check_options(const MappingOptions& options) {
  if (options.frames != ":")
    throw Error("--frames chooses frames of a recording; leave it away where a camera sends them");
  if (options.poses == "given" || options.poses == "refine")
    throw Error(concat("a camera gives no poses; leave --poses ", options.poses,
                       " away, and they are found"));
}

}  // namespace

CameraRun::CameraRun(MappingOptions& options)
    : config_(read_program_config(options)),
      camera_((check_options(options), open_camera(options.source, config_.source))),
      intake_(static_cast<std::size_t>(config_.live.queue)),
      feed_(*camera_, intake_) {
  options.poses = "track";
  if (!camera_->registered())
    warn(concat(camera_->name(),
                " does not bring its depth to the colour image, so the two are taken to look from "
                "one place; docs/cameras.md says how to calibrate them"));
}

bool CameraRun::report_loss() {
  feed_.stop();
  if (feed_.fault().empty()) return true;
  warn(concat(camera_->name(), " ", feed_.fault(), "; what it showed until then is in the map"));
  return false;
}

}  // namespace ovimap::apps
