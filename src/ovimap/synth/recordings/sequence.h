// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/geometry/mesh.h"
#include "ovimap/synth/camera/gyroscope.h"
#include "ovimap/synth/camera/sensor_noise.h"
#include "ovimap/synth/camera/trajectory.h"
#include "ovimap/synth/camera/video_camera.h"
#include "ovimap/synth/camera/walk.h"
#include "ovimap/synth/recordings/figure.h"
#include "ovimap/synth/render/renderer.h"
#include "ovimap/synth/render/truth_mesh.h"
#include "ovimap/synth/rooms/room.h"

namespace ovimap {

struct SynthSequenceConfig {
  bool noise = false;  ///< whether frames look as a depth camera gives them, or exact
  RenderConfig render;
  TrajectoryConfig trajectory;
  SensorNoiseConfig sensor;
  TruthMeshConfig truth;
  FigureConfig figure;  ///< who walks through the room
};
void list_fields(SynthSequenceConfig& config, ConfigFields& fields);

/// How a walk is filmed; the camera's own side counts where SynthSequenceConfig::noise is set.
struct VideoConfig {
  WalkConfig walk;
  VideoCameraConfig camera;
  GyroscopeConfig gyroscope;
};
void list_fields(VideoConfig& config, ConfigFields& fields);

/// One instance of the truth.
struct TruthInstance {
  std::uint32_t id = 0;
  std::string name;
  std::uint32_t class_id = 0;  ///< room_class_id(class_name)
  std::string class_name;
  std::string room = {};       ///< of a floor plan; else empty
  std::string substance = {};  ///< what most of it is made of; empty: not said
};

/// Posed RGB-D frames of a room with exact truth: pictures from all sides, far apart, or the video
/// of a walk. Frames are drawn when read, each from its position and the room's seed alone: any
/// order and any subset gives the same bits. Colour and depth share one camera.
class SynthSequence final : public FrameSource {
 public:
  SynthSequence(SynthRoom room, const PinholeCamera& camera, int frames,
                const SynthSequenceConfig& config = {});
  /// The video of a walk. Throws Error where there is no room to walk.
  SynthSequence(SynthRoom room, const PinholeCamera& camera, const VideoConfig& video,
                const SynthSequenceConfig& config = {});
  ~SynthSequence() override;
  SynthSequence(SynthSequence&&) noexcept;
  SynthSequence& operator=(SynthSequence&&) noexcept;

  std::string kind() const override { return "synth"; }
  std::int64_t size() const override;
  [[nodiscard]] FrameRead read(std::int64_t position) const override;
  [[nodiscard]] std::optional<IdImage> truth_ids(std::int64_t position) const override;

  const SynthRoom& room() const;
  const PinholeCamera& camera() const;
  const std::vector<Pose>& true_poses() const;  ///< world_from_camera, without noise
  bool is_video() const;                        ///< whether frames have true times

  /// What the camera's gyroscope measures on the walk; empty where it has none.
  std::vector<TurnRate> turn_rates() const;
  /// In the order of their ids; a figure and what it carries come last.
  std::vector<TruthInstance> instances() const;
  /// The ids of what moves: a figure and what it carries, or nothing.
  std::vector<std::uint32_t> moving() const;
  /// The labelled surfaces that at least one frame sees, or would see if nobody stood before them;
  /// what moves is not among them.
  Mesh truth_mesh() const;
  /// Who made the models in the room, as a text to go beside anything drawn from it (Markdown).
  std::string notice() const;
  /// Everything the frames depend on, as YAML: two sequences with the same settings are the same.
  std::string settings() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ovimap
