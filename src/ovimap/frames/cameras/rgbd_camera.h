// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "ovimap/frames/frame/frame_source.h"

namespace ovimap {

/// A frame, or why no more come; neither: none came in time.
struct CameraRead {
  std::optional<Frame> frame;  ///< without pose, index and name
  std::string fault;           ///< a sentence's end, as "was unplugged"
};

/// A camera of colour and depth that is plugged in and sends images.
class RgbdCamera {
 public:
  virtual ~RgbdCamera() = default;
  /// What its maker calls it.
  virtual const std::string& name() const = 0;
  /// Depth is that of the colour camera's pixels; else nothing is known of where the two cameras
  /// are, and they are taken to be in one place.
  virtual bool registered() const = 0;
  /// What the camera measures depth in.
  virtual double depth_units_per_m() const = 0;
  /// The next frame, by the camera's own clock. For one thread.
  virtual CameraRead next(std::chrono::milliseconds patience) = 0;
};

/// Whether SOURCE names a camera: "openni:" or "openni:URI".
bool names_camera(const std::string& source);

/// The camera that SOURCE names, which sends from here on. Throws Error where there is none,
/// several fit, it cannot do what is needed, or this program or machine lacks the maker's library.
std::unique_ptr<RgbdCamera> open_camera(const std::string& source,
                                        const FrameSourceConfig& config = {});

}  // namespace ovimap
