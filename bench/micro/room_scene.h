// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/image/image.h"

namespace ovimap::bench {

/// Fixed input for the kernels: the inside of a 4 x 5 x 2.5 m room with three balls, 640 x 480
/// depth with a little repeatable noise, seen while turning on the spot.
struct RoomScene {
  PinholeCamera camera{640, 480, 585.f, 585.f, 319.5f, 239.5f};
  Pose pose;
  DepthImage depth;

  explicit RoomScene(int view) : pose(pose_of(view)), depth(camera.width, camera.height) {
    std::uint32_t seed = static_cast<std::uint32_t>(view) + 1u;
    const Eigen::Vector3f eye = pose.translation().cast<float>();
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        const Eigen::Vector3f ray =
            pose.linear().cast<float>() *
            camera.unproject(static_cast<float>(x), static_cast<float>(y), 1.f);
        seed = seed * 1664525u + 1013904223u;
        const float z = trace(eye, ray);
        depth.at(x, y) = z + 0.002f * z * (static_cast<float>(seed >> 8) / 16777216.f - 0.5f);
      }
  }

 private:
  static Pose pose_of(int view) {
    Pose result = Pose::Identity();
    result.linear() = Eigen::AngleAxisd(0.1 * view, Eigen::Vector3d::UnitY()).matrix();
    return result;
  }

  static float trace(const Eigen::Vector3f& eye, const Eigen::Vector3f& ray) {
    const Eigen::Vector3f half(2.f, 1.25f, 2.5f);
    float nearest = 1e9f;
    for (int axis = 0; axis < 3; ++axis) {
      if (ray[axis] == 0.f) continue;
      const float wall = (std::copysign(half[axis], ray[axis]) - eye[axis]) / ray[axis];
      nearest = std::min(nearest, wall);
    }
    for (const Eigen::Vector3f& center :
         {Eigen::Vector3f(0.4f, 0.3f, 1.5f), Eigen::Vector3f(-0.5f, 0.2f, 1.8f),
          Eigen::Vector3f(1.2f, 0.5f, -1.f)}) {
      const Eigen::Vector3f from = eye - center;
      const float a = ray.squaredNorm(), b = ray.dot(from), c = from.squaredNorm() - 0.09f;
      if (b * b > a * c && -b - std::sqrt(b * b - a * c) > 0.f)
        nearest = std::min(nearest, (-b - std::sqrt(b * b - a * c)) / a);
    }
    return nearest;
  }
};

}  // namespace ovimap::bench
