// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/synth/render/ray_scene.h"
#include "ovimap/synth/rooms/room.h"

namespace ovimap {

class ConfigFields;

struct TrajectoryConfig {
  float lowest_eye_m = 1.25f, highest_eye_m = 1.65f;  ///< heights between which the camera sways
  float body_radius_m = 0.25f;  ///< kept between the camera and walls or tall furniture
  float low_furniture_cost =
      12.f;      ///< how much longer a way is preferred to one over low furniture
  int laps = 2;  ///< rounds of the room; those after the first go nearer to the middle
  float max_turn_rad = 0.35f;      ///< between two frames
  float max_gaze_turn_rad = 0.7f;  ///< between two decisions where to look
};
void list_fields(TrajectoryConfig& config, ConfigFields& fields);

/// Camera poses (world_from_camera) of somebody walking round the room with the camera in hand:
/// laps that avoid furniture where they can, looking at whatever was seen least from that side so
/// far.
std::vector<Pose> plan_trajectory(const SynthRoom& room, const RayScene& scene,
                                  const PinholeCamera& camera, int frames,
                                  const TrajectoryConfig& config = {});

/// The camera at `eye_m` looking in a direction given by its turn about the vertical (0: along x,
/// counter-clockwise) and its elevation, rolled clockwise.
Pose looking(const Eigen::Vector3d& eye_m, double yaw_rad, double pitch_rad, double roll_rad);

}  // namespace ovimap
