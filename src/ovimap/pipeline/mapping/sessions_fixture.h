// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/pipeline/mapping/furnished_fixture.h"

namespace ovimap {

inline const std::vector<Furniture> kThings = {
    furniture(-0.9f, 0.9f, {0.6f, 0.4f, 0.5f}, {190, 120, 40}),
    furniture(0.6f, 0.3f, {0.3f, 0.3f, 0.3f}, {220, 20, 20}),
    furniture(0.2f, -0.9f, {0.35f, 0.25f, 0.4f}, {20, 30, 220}),
    furniture(-1.3f, -0.6f, {0.45f, 0.3f, 0.2f}, {20, 200, 30}),
    furniture(1.5f, 1.1f, {0.25f, 0.5f, 0.35f}, {200, 200, 20}),
};

/// The room of kThings, seen over a part of the camera's circle; the world is a frame of its own.
inline FurnishedRoom visited(double first_turn, double last_turn,
                             const Pose& world_from_room = Pose::Identity()) {
  FurnishedRoom room;
  room.things = kThings;
  room.first_turn = first_turn;
  room.last_turn = last_turn;
  room.world_from_room = world_from_room;
  return room;
}

inline MapDocument session(double first_turn, double last_turn,
                           const Pose& world_from_room = Pose::Identity()) {
  return map_of(visited(first_turn, last_turn, world_from_room));
}

inline Pose elsewhere() {
  Pose pose(Eigen::AngleAxisd(2.1, Eigen::Vector3d::UnitZ()));
  pose.translation() = Eigen::Vector3d(3.1, -1.7, 0.4);
  return pose;
}

}  // namespace ovimap
