// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/synth/camera/spline.h"
#include "ovimap/synth/render/ray_scene.h"
#include "ovimap/synth/rooms/room.h"
#include "ovimap/synth/shapes/random.h"

namespace ovimap {

class ConfigFields;

/// Amplitudes are half of what lies between the extremes. The body's sway is that of people who
/// walk at 0.7 m/s: 6.99 cm from side to side, 2.74 cm up and down (Orendurff et al., "The effect
/// of walking speed on center of mass displacement", J. Rehabil. Res. Dev. 41(6A), 2004). Hands
/// tremble at 8 to 12 Hz by about a tenth of a millimetre (Elble and Koller, "Tremor", 1990). How
/// much a held camera turns with the steps and drifts is our choice.
struct WalkConfig {
  float fps = 30;               ///< frames a second
  float seconds = 0;            ///< how long; 0: once round
  float speed_mps = 0.7f;       ///< of the body on straight ways; slower in turns
  float max_turn_rad_s = 0.7f;  ///< of the gaze, sway and tremor aside
  float eye_m = 1.45f;          ///< mean height of the camera
  float body_radius_m = 0.25f;  ///< kept from walls and tall furniture, half of it from low pieces
  float steps_per_s = 1.5f;
  float rise_m = 0.0137f;      ///< up and down, with every step
  float sideways_m = 0.035f;   ///< to the right and left, with every second step
  float nod_rad = 0.006f;      ///< pitch, with every step
  float roll_rad = 0.010f;     ///< with every second step
  float drift_m = 0.03f;       ///< slow motion of the arms along each axis, 0.1 to 0.4 Hz
  float drift_rad = 0.02f;     ///< and about each axis
  float tremor_m = 0.0001f;    ///< 8 to 12 Hz, along each axis
  float tremor_rad = 0.0005f;  ///< and about each axis
  float whip_rad_s = 0;        ///< every few seconds a pan aside and back, so fast at most; 0: none
};
void list_fields(WalkConfig& config, ConfigFields& fields);

/// A few sine waves of random frequency and phase: smooth noise within [-1, 1].
class Wobble {
 public:
  Wobble(Random& random, float lowest_hz, float highest_hz);
  double at(double time_s) const;

 private:
  static constexpr std::size_t kWaves = 4;
  std::array<double, kWaves> speed_rad_s_{}, phase_rad_{};
};

/// A camera carried through rooms by somebody who walks: a pose at every moment, continuous up to
/// the second derivative in place and direction.
class Walk {
 public:
  /// `path`: where the body is, metres; `gaze`: yaw and pitch over time, radians.
  Walk(PlaneSpline path, PlaneSpline gaze, double seconds, std::uint64_t seed,
       const WalkConfig& config);

  Pose at(double time_s) const;  ///< world_from_camera
  double seconds() const { return seconds_; }

 private:
  PlaneSpline path_, gaze_;
  double seconds_;
  WalkConfig config_;
  double step_phase_rad_;
  std::vector<Wobble> drift_, tremor_;  ///< three axes of place, then of rotation
};

/// The way on the floor plan: a closed round through the room, or through all rooms of a plan in
/// their order, as far as they can be reached without stepping over furniture, as control points
/// `spacing_m` apart. Throws Error where there is no room to walk.
std::vector<Eigen::Vector2d> walking_round(const SynthRoom& room, const WalkConfig& config,
                                           double spacing_m);

/// Whether somebody can walk to all of these points of the floor plan from wherever most of it can
/// be reached.
bool all_reachable(const SynthRoom& room, const WalkConfig& config,
                   const std::vector<Eigen::Vector2f>& points_m);

/// Walks the round as long as asked for, looking at whatever was seen least so far. The same room
/// and settings give the same walk.
Walk plan_walk(const SynthRoom& room, const RayScene& scene, const PinholeCamera& camera,
               const WalkConfig& config = {});

}  // namespace ovimap
