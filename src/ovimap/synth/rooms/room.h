// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/synth/shapes/oriented_box.h"
#include "ovimap/synth/shapes/texture.h"

namespace ovimap {

/// What a door's leaf turns about, upright. Opening turns it clockwise, seen from above.
struct Hinge {
  Eigen::Vector2f at_m = Eigen::Vector2f::Zero();
  float shut_yaw_rad = 0;  ///< of the leaf's footprint when it is shut
};

/// One instance of a room: a piece of furniture, a wall, the floor, a picture.
struct RoomObject {
  std::uint16_t id = 0;     ///< 1, 2, ... in the room's order
  std::string name;         ///< "Coffee mug", "north wall"
  std::string class_name;   ///< "mug", "wall"
  std::string room;         ///< of a floor plan: the room it is in; empty in a single room
  std::string source;       ///< who made the model and its licence; empty for our own surfaces
  TexturedMesh mesh;        ///< in the world frame: metres, z up, floor at z = 0
  Eigen::AlignedBox3f box;  ///< of the mesh
  std::optional<OrientedBox> footprint;  ///< the space it takes; floor, walls and ceiling have none
  std::optional<Hinge> hinge;            ///< of a door's leaf that can turn
};

/// A rectangle that shines to one side.
struct AreaLight {
  Eigen::Vector3f center_m, half_width_m, half_height_m;
  Eigen::Vector3f normal;  ///< unit length, the side that shines
  Eigen::Vector3f
      intensity;  ///< linear RGB along the normal: what falls on a surface 1 m away, facing it
};

/// One room of a floor plan.
struct RoomZone {
  std::string name;
  Eigen::AlignedBox2f floor_m;
};

/// Where somebody stands who films a place, and what at; moments follow each other at equal times.
struct SurveyMoment {
  Eigen::Vector2f eye_m, target_m;
  float target_height_m = 0;
};

/// A furnished room, or several with walls between them. The floor is z = 0; all of it lies in
/// [0, width] x [0, depth] x [0, height].
struct SynthRoom {
  std::string name;
  std::uint64_t seed = 0;
  Eigen::Vector3f size_m = Eigen::Vector3f::Zero();
  std::vector<RoomObject> objects;  ///< objects[i].id == i + 1; without mesh: it is away (visits.h)
  std::vector<AreaLight> lights;
  std::vector<RoomZone> zones;     ///< of a floor plan, in the order of a walk; else empty
  std::vector<OrientedBox> walls;  ///< of a floor plan: what a body cannot walk through, doors open
  std::vector<SurveyMoment> survey;  ///< how a walk films it; empty: from a round through it
  float faint_light = 0;  ///< lamps are left out where they would add less than this, unhidden
  Eigen::Vector3f ambient = Eigen::Vector3f::Constant(0.5f);  ///< light from everywhere, linear RGB
};

}  // namespace ovimap
