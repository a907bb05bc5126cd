// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests only: frames of the analytic room with texture, and a map of them.

#include <cmath>

#include "ovimap/frames/recording/sequence_fixture.h"
#include "ovimap/map/fusion/integrate.h"
#include "ovimap/track/tracker.h"

namespace ovimap::fixture {

/// Takes pictures of the room from anywhere.
struct RoomCamera {
  PinholeCamera camera{160, 120, 140.f, 140.f, 79.5f, 59.5f};
  bool textured = true;

  static std::uint8_t shade(const Eigen::Vector3d& p, double phase) {
    const double value = 120 + 45 * std::sin(5 * p.x() + 3 * p.y() + phase) +
                         35 * std::sin(7 * p.z() - 4 * p.y() + 2 * phase) +
                         30 * std::sin(11 * p.x() * p.z() + 9 * p.y());
    return static_cast<std::uint8_t>(std::clamp(value, 1., 255.));
  }

  Frame take(const Pose& world_from_camera, std::int64_t index = 0) const {
    Frame frame;
    frame.index = index;
    frame.name = concat("frame ", index);
    frame.timestamp_s = static_cast<double>(index) / 30;
    frame.depth_camera = frame.color_camera = camera;
    frame.depth = DepthImage(camera.width, camera.height);
    frame.color = RgbImage(camera.width, camera.height, {128, 128, 128});
    frame.world_from_camera = world_from_camera;
    const Eigen::Vector3d eye = world_from_camera.translation();
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u) {
        const Eigen::Vector3d ray =
            world_from_camera.linear() * camera.unproject(float(u), float(v), 1.f).cast<double>();
        const double depth = trace_room(eye, ray).distance;
        frame.depth.at(u, v) = static_cast<float>(depth);
        const Eigen::Vector3d point = eye + depth * ray;
        if (textured) frame.color.at(u, v) = {shade(point, 0), shade(point, 1), shade(point, 2)};
      }
    return frame;
  }
};

inline void fuse(const Frame& frame, VoxelMap& map) {
  integrate(map, {.depth = frame.depth,
                  .camera = frame.depth_camera,
                  .world_from_camera = frame.world_from_camera});
}

inline VoxelMap coarse_map() {
  VoxelMapConfig config;
  config.voxel_size_m = 0.02f;
  return VoxelMap(config);
}

/// Tracks a frame and fuses it where it was found, as a run does.
inline const TrackedFrame& track_and_fuse(Tracker& tracker, Frame frame, VoxelMap& map) {
  frame.posed = false;
  const TrackedFrame& tracked = tracker.track(frame, map);
  frame.world_from_camera = tracked.world_from_camera;
  if (tracked.tracked) fuse(frame, map);
  return tracked;
}

inline double distance_m(const Pose& a, const Pose& b) {
  return (a.inverse() * b).translation().norm();
}
inline double angle_rad(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd((a.inverse() * b).linear()).angle();
}

}  // namespace ovimap::fixture
