// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/image/image.h"

namespace ovimap {

/// One RGB-D observation, with its pose where that is known. Colour and depth may come from two
/// cameras that were never registered.
struct Frame {
  std::int64_t index = 0;  ///< position in its source
  std::string name;        ///< file stem of the colour image; names 2D mask files (`--masks DIR`)
  double timestamp_s = 0;
  RgbImage color;  ///< native colour image, color_camera's size
  PinholeCamera color_camera;
  DepthImage depth;  ///< metres; every invalid value (0, NaN, inf, out of range) stored as 0
  /// What a filter took out of `depth` (people): the depth that it had, 0 elsewhere; empty: nothing
  /// was. It tells what is empty and what moves; nothing may be made of it.
  DepthImage taken_out;
  PinholeCamera depth_camera;
  Pose color_from_depth = Pose::Identity();   ///< x_in_color = color_from_depth * x_in_depth
  Pose world_from_camera = Pose::Identity();  ///< of the depth camera
  bool posed = true;                          ///< world_from_camera is known
  /// Of the depth camera, world_from_camera, as a gyroscope's turns add up, in a world of their own
  /// that drifts: what two frames near each other in time differ by is how the camera turned.
  std::optional<Eigen::Quaterniond> orientation;

  /// Colour and depth share camera and pose: pixel (u, v) is the same ray in both.
  bool registered() const {
    return color_camera == depth_camera && color_from_depth.matrix().isIdentity(1e-9);
  }
};

}  // namespace ovimap
