// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "ovimap/synth/camera/trajectory.h"
#include "ovimap/synth/render/renderer.h"
#include "ovimap/synth/rooms/room.h"

namespace ovimap {

class ConfigFields;

struct FigureConfig {
  bool enabled = false;
  float height_m = 1.7f;
  float speed_mps = 0.8f;
  float stride_m = 0.7f;    ///< of one leg's swing
  float picture_s = 0.25f;  ///< between two pictures that are no video
  float radius_m = 0.3f;    ///< kept between its middle and walls or tall furniture
};
void list_fields(FigureConfig& config, ConfigFields& fields);

/// Somebody who walks to and fro in a room with a carton in the hands: body, head, swinging legs
/// and arms of round bars and boxes. It casts no shadow. The same room and seed give the same walk
/// on every machine.
class Figure {
 public:
  /// The figure's truth has the id after the room's last, what it carries the next one. Throws
  /// Error where there is no floor to walk on.
  Figure(const SynthRoom& room, const FigureConfig& config, const TrajectoryConfig& walk,
         std::uint64_t seed);

  /// The figure and what it carries, in the room's frame at that time, to be drawn with the room.
  MovingThing at(double time_s) const;

  /// Person, then carton: ids, names and classes; meshes in the figure's own frame (base at the
  /// origin, walking towards +x).
  const std::vector<RoomObject>& objects() const { return postures_.front(); }

 private:
  FigureConfig config_;
  std::vector<Eigen::Vector2f> way_;  ///< closed
  std::vector<double> along_m_;       ///< from its first point to each, and to the first again
  std::vector<std::vector<RoomObject>> postures_;  ///< over one step with each leg
  std::vector<SurfaceTracer> tracers_;             ///< of those
};

}  // namespace ovimap
