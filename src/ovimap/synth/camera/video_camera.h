// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ovimap/geometry/camera.h"
#include "ovimap/synth/camera/walk.h"
#include "ovimap/synth/render/renderer.h"

namespace ovimap {

class ConfigFields;

/// The colour side of a video camera: a global shutter that stays open, and automatic exposure that
/// follows the light a little late. The constants are our choice, within what cameras of phones and
/// depth sensors do indoors.
struct VideoCameraConfig {
  float shutter_s = 1.f / 60;  ///< how long it is open, around a frame's time; 0: no motion blur
  int max_subframes = 8;       ///< pictures averaged for one frame
  float still_px = 0.5f;       ///< what moves less across the picture is sharp
  bool auto_exposure = true;
  float brightness = 0.28f;  ///< mean of the linear picture that the exposure aims at
  float response_s = 0.3f;   ///< time constant with which it follows
  float least_exposure = 0.5f, most_exposure = 2.f;  ///< factors on RenderConfig::exposure
};
void list_fields(VideoCameraConfig& config, ConfigFields& fields);

/// Where the camera is while the shutter is open, in equal steps around `time_s`: as many as it
/// takes for one pixel a step at the picture's middle (things 1 m away), at most max_subframes.
/// Empty where nothing moves by more than still_px.
std::vector<Pose> shutter_poses(const Walk& walk, const PinholeCamera& camera, double time_s,
                                const VideoCameraConfig& config);

/// The exposure over a walk, metered on small pictures of what the camera sees.
class AutoExposure {
 public:
  AutoExposure(const Renderer& renderer, const PinholeCamera& camera, const Walk& walk,
               const VideoCameraConfig& config);

  float at(double time_s) const;  ///< factor on RenderConfig::exposure

 private:
  std::vector<float> factors_;  ///< kMeterSpacing_s apart
};

}  // namespace ovimap
