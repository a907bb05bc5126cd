// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "ovimap/frames/check/source_check.h"
#include "ovimap/frames/frame/frame.h"

namespace ovimap {

/// When a frame was taken and how far its picture is smeared.
struct Capture {
  double timestamp_s = 0;
  std::optional<float> smear;  ///< width of its edges along rows or columns, the wider, as a share
                               ///< of the picture's width; nothing: too few edges tell
};

Capture capture_of(const Frame& frame);

/// What is wrong with how a recording was taken, though each of its frames can be read: "clock"
/// where times go backwards, "blur" where the camera moved too fast for its shutter or was out of
/// focus. `captures`: frames of it, in order.
std::vector<Finding> check_captures(const std::vector<Capture>& captures);

}  // namespace ovimap
