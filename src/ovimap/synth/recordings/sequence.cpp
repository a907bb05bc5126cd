// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/recordings/sequence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <set>

#include "ovimap/base/config.h"
#include "ovimap/synth/furniture/furniture_palette.h"
#include "ovimap/synth/shapes/mesh_parts.h"
#include "ovimap/synth/shapes/random.h"

namespace ovimap {
namespace {

constexpr double kFramesPerSecond = 30;
constexpr float kTruthSpacing_s = 0.2f;
constexpr std::uint64_t kFrameStream = 9001;

std::string frame_name(std::int64_t position) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "frame%06lld", static_cast<long long>(position));
  return text.data();
}

}  // namespace

void list_fields(SynthSequenceConfig& config, ConfigFields& fields) {
  fields.add("noise", config.noise, "whether frames look as a depth camera gives them, or exact");
  fields.group("render", [&](ConfigFields& group) { list_fields(config.render, group); });
  fields.group("trajectory", [&](ConfigFields& group) { list_fields(config.trajectory, group); });
  fields.group("sensor", [&](ConfigFields& group) { list_fields(config.sensor, group); });
  fields.group("truth", [&](ConfigFields& group) { list_fields(config.truth, group); });
  if (config.figure.enabled)  // rooms without are what they were before there were figures
    fields.group("figure", [&](ConfigFields& group) { list_fields(config.figure, group); });
}

void list_fields(VideoConfig& config, ConfigFields& fields) {
  fields.group("walk", [&](ConfigFields& group) { list_fields(config.walk, group); });
  fields.group("camera", [&](ConfigFields& group) { list_fields(config.camera, group); });
  if (config.gyroscope.rate_hz > 0)  // walks without are what they were before there were any
    fields.group("gyroscope", [&](ConfigFields& group) { list_fields(config.gyroscope, group); });
}

struct SynthSequence::State {
  State(SynthRoom made_room, const PinholeCamera& made_camera, int frames,
        const SynthSequenceConfig& sequence_config)
      : room(std::move(made_room)),
        camera(made_camera),
        config(sequence_config),
        renderer(room, config.render),
        poses(plan_trajectory(room, renderer.scene(), camera, frames, config.trajectory)) {
    add_figure();
  }
  State(SynthRoom made_room, const PinholeCamera& made_camera, const VideoConfig& video_config,
        const SynthSequenceConfig& sequence_config)
      : room(std::move(made_room)),
        camera(made_camera),
        config(sequence_config),
        renderer(room, config.render),
        video(Video{video_config, plan_walk(room, renderer.scene(), camera, video_config.walk)}) {
    if (config.noise && video_config.camera.auto_exposure)
      video->exposure.emplace(renderer, camera, video->walk, video_config.camera);
    const double frames = video->walk.seconds() * static_cast<double>(video_config.walk.fps);
    for (std::int64_t i = 0; i < std::max(1L, std::lround(frames)); ++i)
      poses.push_back(video->walk.at(time_s(i)));
    add_figure();
  }

  void add_figure() {
    if (config.figure.enabled) figure.emplace(room, config.figure, config.trajectory, room.seed);
  }

  struct Video {
    VideoConfig config;
    Walk walk;
    std::optional<AutoExposure> exposure = std::nullopt;
  };

  SynthRoom room;
  PinholeCamera camera;
  SynthSequenceConfig config;
  Renderer renderer;
  std::optional<Video> video;
  std::optional<Figure> figure;
  std::vector<Pose> poses;

  double time_s(std::int64_t position) const {
    return static_cast<double>(position) /
           (video ? static_cast<double>(video->config.walk.fps) : kFramesPerSecond);
  }

  /// What moves, where it is in that frame.
  MovingThing thing_at(std::int64_t position) const {
    if (!figure) return {};
    return figure->at(video ? time_s(position)
                            : static_cast<double>(position) *
                                  static_cast<double>(config.figure.picture_s));
  }

  /// Frames of a video hardly differ: a few a second show all that is seen.
  std::size_t truth_stride() const {
    return video ? static_cast<std::size_t>(std::max(1.f, video->config.walk.fps * kTruthSpacing_s))
                 : 1;
  }

  RenderedView render(std::int64_t position) const {
    const Pose& pose = poses[static_cast<std::size_t>(position)];
    const MovingThing thing = thing_at(position);
    if (!video || !config.noise) return renderer.render(camera, pose, true, thing);
    const double time = time_s(position);
    Shutter shutter{shutter_poses(video->walk, camera, time, video->config.camera)};
    if (video->exposure) shutter.exposure = video->exposure->at(time);
    return renderer.render(camera, pose, shutter, thing);
  }

  void keep_ids(std::int64_t position, const IdImage& ids) {
    const std::lock_guard lock(mutex_);
    last_position_ = position;
    last_ids_ = ids;
  }
  std::optional<IdImage> kept_ids(std::int64_t position) {
    const std::lock_guard lock(mutex_);
    return position == last_position_ ? std::optional(last_ids_) : std::nullopt;
  }

 private:
  // The ids of the frame read last: who writes a frame asks for them next.
  std::mutex mutex_;
  std::int64_t last_position_ = -1;
  IdImage last_ids_;
};

SynthSequence::SynthSequence(SynthRoom room, const PinholeCamera& camera, int frames,
                             const SynthSequenceConfig& config)
    : state_(std::make_unique<State>(std::move(room), camera, frames, config)) {}
SynthSequence::SynthSequence(SynthRoom room, const PinholeCamera& camera, const VideoConfig& video,
                             const SynthSequenceConfig& config)
    : state_(std::make_unique<State>(std::move(room), camera, video, config)) {}
SynthSequence::~SynthSequence() = default;
SynthSequence::SynthSequence(SynthSequence&&) noexcept = default;
SynthSequence& SynthSequence::operator=(SynthSequence&&) noexcept = default;

std::int64_t SynthSequence::size() const {
  return static_cast<std::int64_t>(state_->poses.size());
}
const SynthRoom& SynthSequence::room() const {
  return state_->room;
}
const PinholeCamera& SynthSequence::camera() const {
  return state_->camera;
}
const std::vector<Pose>& SynthSequence::true_poses() const {
  return state_->poses;
}

bool SynthSequence::is_video() const {
  return state_->video.has_value();
}

FrameRead SynthSequence::read(std::int64_t position) const {
  if (position < 0 || position >= size())
    return {std::nullopt, concat("frame ", position, ": the sequence has ", size(), " frames")};
  const Pose& pose = state_->poses[static_cast<std::size_t>(position)];
  RenderedView view = state_->render(position);
  state_->keep_ids(position, view.ids);
  Frame frame;
  frame.index = position;
  frame.name = frame_name(position);
  frame.timestamp_s = state_->time_s(position);
  frame.color_camera = frame.depth_camera = state_->camera;
  if (state_->config.noise) {
    const SensorNoiseConfig& sensor = state_->config.sensor;
    const std::uint64_t seed =
        Random(state_->room.seed, kFrameStream + static_cast<std::uint64_t>(position)).bits();
    frame.depth = noisy_depth(view, sensor, seed);
    frame.color = noisy_color(view.color, sensor, seed);
    frame.world_from_camera = noisy_pose(pose, sensor, seed);
  } else {
    frame.depth = std::move(view.depth);
    frame.color = std::move(view.color);
    frame.world_from_camera = pose;
  }
  return {std::move(frame), {}};
}

std::optional<IdImage> SynthSequence::truth_ids(std::int64_t position) const {
  if (position < 0 || position >= size()) return std::nullopt;
  if (auto ids = state_->kept_ids(position)) return ids;
  const Pose& pose = state_->poses[static_cast<std::size_t>(position)];
  return state_->renderer.render(state_->camera, pose, false, state_->thing_at(position)).ids;
}

std::vector<TurnRate> SynthSequence::turn_rates() const {
  if (!state_->video) return {};
  return gyroscope_samples(state_->video->walk, state_->video->config.gyroscope, state_->room.seed);
}

std::vector<TruthInstance> SynthSequence::instances() const {
  std::vector<TruthInstance> instances;
  for (const RoomObject& object : state_->room.objects)
    if (!object.box.isEmpty())
      instances.push_back({object.id, object.name, room_class_id(object.class_name),
                           object.class_name, object.room, main_substance(object.mesh)});
  if (state_->figure)
    for (const RoomObject& object : state_->figure->objects())
      instances.push_back({object.id, object.name, room_class_id(object.class_name),
                           object.class_name, object.room});
  return instances;
}

std::vector<std::uint32_t> SynthSequence::moving() const {
  std::vector<std::uint32_t> ids;
  if (state_->figure)
    for (const RoomObject& object : state_->figure->objects()) ids.push_back(object.id);
  return ids;
}

Mesh SynthSequence::truth_mesh() const {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < state_->poses.size(); i += state_->truth_stride())
    poses.push_back(state_->poses[i]);
  return seen_part(surface_mesh(state_->room, state_->config.truth), state_->renderer.scene(),
                   state_->camera, poses, state_->config.truth);
}

std::string SynthSequence::notice() const {
  std::set<std::string> sources;
  for (const RoomObject& object : state_->room.objects)
    if (!object.source.empty()) sources.insert(object.source);
  std::string text = concat("# Notice\n\nThe room \"", state_->room.name, "\" (seed ",
                            state_->room.seed, ") was drawn by ovimap.\n");
  if (sources.empty()) return text;
  text +=
      "It shows these models of the Sweet Home 3D furniture libraries "
      "(https://www.sweethome3d.com), "
      "scaled, turned and placed:\n\n";
  for (const std::string& source : sources) text += "- " + source + "\n";
  return text;
}

std::string SynthSequence::settings() const {
  const PinholeCamera& camera = state_->camera;
  ConfigFields fields;
  list_fields(state_->config, fields);
  if (state_->video)
    fields.group("video", [&](ConfigFields& group) { list_fields(state_->video->config, group); });
  return concat("room: ", state_->room.name, "\nseed: ", state_->room.seed, "\nframes: ", size(),
                "\ncamera: {width: ", camera.width, ", height: ", camera.height,
                ", fx: ", camera.fx, ", fy: ", camera.fy, ", cx: ", camera.cx, ", cy: ", camera.cy,
                "}\n", fields.dump());
}

}  // namespace ovimap
