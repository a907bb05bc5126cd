// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Geometry>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"

namespace ovimap {

/// Whether no part of a sphere (camera frame, metres) may show in the image: all of it lies off one
/// side of the view's pyramid.
inline bool beyond_view(const PinholeCamera& camera, const Eigen::Vector3f& center, float radius) {
  const auto beyond = [&](float offset, float slope) {
    return offset - slope * center.z() > radius * std::sqrt(1.f + slope * slope);
  };
  return beyond(center.x(), (static_cast<float>(camera.width) - camera.cx) / camera.fx) ||
         beyond(-center.x(), (camera.cx + 1.f) / camera.fx) ||
         beyond(center.y(), (static_cast<float>(camera.height) - camera.cy) / camera.fy) ||
         beyond(-center.y(), (camera.cy + 1.f) / camera.fy);
}

/// A box of pixels around where a sphere shows (camera frame, metres), which may reach over the
/// image; all of the sphere lies before the camera.
inline Eigen::AlignedBox2f pixels_around(const PinholeCamera& camera, const Eigen::Vector3f& center,
                                         float radius) {
  const float near_m = center.z() - radius, far_m = center.z() + radius;
  // The tangent planes through the eye lie nearer in; this box of the sphere's is wider.
  const auto lowest = [&](float edge) { return edge / (edge < 0.f ? near_m : far_m); };
  const auto highest = [&](float edge) { return edge / (edge > 0.f ? near_m : far_m); };
  return {Eigen::Vector2f(camera.cx + camera.fx * lowest(center.x() - radius),
                          camera.cy + camera.fy * lowest(center.y() - radius)),
          Eigen::Vector2f(camera.cx + camera.fx * highest(center.x() + radius),
                          camera.cy + camera.fy * highest(center.y() + radius))};
}

/// A box of the world around what shows in the image up to `far_m` along the camera's axis, the
/// camera included.
inline Eigen::AlignedBox3d box_of_view(const PinholeCamera& camera, const Pose& world_from_camera,
                                       float far_m) {
  Eigen::AlignedBox3d box(world_from_camera.translation());
  for (const float u : {0.f, static_cast<float>(camera.width - 1)})
    for (const float v : {0.f, static_cast<float>(camera.height - 1)})
      box.extend(world_from_camera * camera.unproject(u, v, far_m).cast<double>());
  return box;
}

}  // namespace ovimap
