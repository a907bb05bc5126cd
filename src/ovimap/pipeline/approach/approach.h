// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "ovimap/pipeline/approach/standing_space.h"

namespace ovimap {

class ConfigFields;

/// A round robot with a camera above its middle, which turns up and down to what it looks at.
struct ApproachConfig {
  float radius_m = 0.25f;        ///< of the robot
  float camera_height_m = 1.2f;  ///< above the floor; the robot is taken to be as high
  float fov_deg = 60.f;          ///< of the camera, a cone
  float range_m = 2.f;           ///< from the object's surface to the robot's middle, on the floor
  float least_seen = 0.3f;       ///< of the object's visible surface
  float good_share = 0.8f;       ///< of the best view: such views go by the length of the way
  int poses = 3;                 ///< at most so many, each a robot's width from the others
  float low_m = 0.1f;            ///< lower things can be driven over
};
void list_fields(ApproachConfig& config, ConfigFields& fields);

/// Where to stand. Grid frame: z is up, the floor at OccupancyGrid::floor_m.
struct ApproachPose {
  Eigen::Vector2f place_m = Eigen::Vector2f::Zero();
  float yaw_rad = 0;   ///< of the gaze, from x towards y
  float tilt_rad = 0;  ///< of the gaze, upwards from level
  float seen = 0;  ///< of the object's visible surface: what is seen from any free place near it
  float distance_m = 0;              ///< from the camera to the object's middle
  float way_m = 0;                   ///< length of the way there; 0 without a start
  std::vector<Eigen::Vector2f> way;  ///< its corners, from the start to here; empty without a start
};

struct Approach {
  std::vector<ApproachPose> poses;  ///< best first
  std::string reason;               ///< why there are none; else empty
};

/// From where an object is seen and can be reached. `from`: where the robot is, grid frame, metres;
/// without it, places count as reached that lie in the largest connected free space. An object
/// without surface in the map, and one that cannot be seen or reached, is a reason, no error.
Approach find_approach(const StandingSpace& space, InstanceId object, const ApproachConfig& config,
                       const std::optional<Eigen::Vector2f>& from = std::nullopt);

}  // namespace ovimap
