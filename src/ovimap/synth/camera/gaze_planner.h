// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "ovimap/geometry/camera.h"
#include "ovimap/synth/render/ray_scene.h"
#include "ovimap/synth/rooms/room.h"

namespace ovimap {

/// Where a camera looks: the turn about the vertical (0: along x, counter-clockwise) and the
/// elevation.
struct Gaze {
  double yaw_rad = 0, pitch_rad = 0;
};

/// Chooses a gaze for each place of a walk so that everything is seen from as many sides as the
/// walk allows, with turns of at most `reach_rad` from one place to the next. The yaws are
/// continuous, not wrapped. Found by improving one place at a time from several first guesses.
std::vector<Gaze> plan_gazes(const SynthRoom& room, const RayScene& scene,
                             const PinholeCamera& camera, std::span<const Eigen::Vector3d> eyes_m,
                             double reach_rad);

}  // namespace ovimap
