// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <numbers>

#include "apps/command/command.h"
#include "ovimap/base/error.h"
#include "ovimap/base/listed.h"
#include "ovimap/base/parallel.h"
#include "ovimap/synth/buildings/benchmark_scenes.h"
#include "ovimap/synth/buildings/floor_plan.h"
#include "ovimap/synth/rooms/room_spec.h"
#include "synth_catalog.h"
#include "synth_room.h"

namespace ovimap::apps {

namespace {

constexpr float kGyroscope_hz = 200;  // of depth cameras: 200 or 400
constexpr int kLeastSide_px = 16, kMostSide_px = 8192;

struct SynthOptions {
  std::filesystem::path out;
  RoomOptions room;
  bool walk = false, exact = false;
  VideoConfig video;
  double whip_deg_s = 0;
  bool gyroscope = false;
  std::vector<CLI::Option*> of_videos;
  std::string size;
  std::vector<std::string> settings;

  bool is_video() const {
    return walk || !room.plan.empty() || !benchmark_scenes(room.room).empty();
  }

  int visits = 0;  ///< 0: one recording
  bool figure = false;
  bool catalog = false;
  int views = PortraitConfig{}.views;
  int threads = 0;
  bool json = false;
};

/// "640x480".
void set_size(const std::string& text, RoomOptions& options) {
  char end = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &options.width, &options.height, &end) != 2 ||
      options.width < kLeastSide_px || options.height < kLeastSide_px ||
      options.width > kMostSide_px || options.height > kMostSide_px)
    throw Error(concat("--size '", text, "': expected WIDTHxHEIGHT in pixels, each from ",
                       kLeastSide_px, " to ", kMostSide_px, ", as 640x480"));
}

RoomOptions chosen_room(const SynthOptions& options, const std::string& room) {
  RoomOptions chosen = options.room;
  chosen.room = room;
  if (options.is_video()) chosen.frames_as.noise = !options.exact;
  chosen.frames_as.figure.enabled = options.figure;
  if (!options.size.empty()) set_size(options.size, chosen);
  ConfigFields fields;
  list_fields(chosen.frames_as, fields);
  apply_settings(options.settings, fields);
  if (options.is_video()) {
    chosen.video = options.video;
    chosen.video->walk.whip_rad_s = static_cast<float>(options.whip_deg_s * std::numbers::pi / 180);
    if (options.gyroscope) chosen.video->gyroscope.rate_hz = kGyroscope_hz;
  }
  return chosen;
}

WrittenRoom render(const SynthOptions& options, const std::string& room, const std::string& scene) {
  const RoomOptions chosen = chosen_room(options, room);
  Progress progress("rendering " + room);
  return write_room(options.out, chosen, scene, [&](std::int64_t done, std::int64_t total) {
    progress.show(static_cast<std::size_t>(done), static_cast<std::size_t>(total));
  });
}

/// A scene of apartments-v1 or desks-v1, filmed as the set says but for what was asked for.
SynthOptions filmed_as(SynthOptions options, const BenchmarkScene& scene) {
  const float asked_fps = options.video.walk.fps, asked_seconds = options.video.walk.seconds,
              asked_speed = options.video.walk.speed_mps;
  options.video.walk = scene.walk;
  for (const CLI::Option* option : options.of_videos) {
    if (option->count() == 0) continue;
    if (option->get_name() == "--fps") options.video.walk.fps = asked_fps;
    if (option->get_name() == "--seconds") options.video.walk.seconds = asked_seconds;
    if (option->get_name() == "--speed") options.video.walk.speed_mps = asked_speed;
  }
  options.room.scene = scene;
  return options;
}

std::vector<WrittenRoom> render_visits(SynthOptions options) {
  const std::vector<BenchmarkScene> scenes = benchmark_scenes(options.room.room);
  if (options.room.room == kRoomsV1 || scenes.size() > 1)
    throw Error(concat("--visits is of one room or plan, not of '", options.room.room,
                       "'; name one with --room or --plan"));
  if (!scenes.empty()) options = filmed_as(std::move(options), scenes.front());
  Progress progress("rendering visits");
  return write_visits(options.out, chosen_room(options, options.room.room), options.visits,
                      [&](std::int64_t done, std::int64_t total) {
                        progress.show(static_cast<std::size_t>(done),
                                      static_cast<std::size_t>(total));
                      });
}

int synth(const SynthOptions& options) {
  for (const CLI::Option* option : options.of_videos)
    if (option->count() > 0 && !options.is_video())
      throw Error(concat(option->get_name(), " is of a walk; add --walk or --plan NAME"));
  if (options.room.frames > 0 && options.is_video())
    throw Error("--frames is of rooms; say how long a walk is with --seconds and --fps");
  const ThreadLimit limit(options.threads);
  if (options.catalog)
    return synth_catalog(
        {options.out, options.room.furniture, options.views, options.room.seed, options.json});
  std::vector<WrittenRoom> rooms;
  if (options.visits > 0)
    rooms = render_visits(options);
  else if (!options.room.plan.empty())
    rooms.push_back(render(options, options.room.plan, options.room.plan));
  else if (const auto scenes = benchmark_scenes(options.room.room); !scenes.empty())
    for (const BenchmarkScene& scene : scenes)
      rooms.push_back(render(filmed_as(options, scene), scene.name, scene.name));
  else if (options.room.room == kRoomsV1)
    for (const std::string& name : rooms_v1_names()) rooms.push_back(render(options, name, name));
  else
    rooms.push_back(render(options, options.room.room, options.walk ? options.room.room : "room"));
  nlohmann::ordered_json scenes = nlohmann::ordered_json::array();
  for (const auto& [scene, frames, objects, moving] : rooms) {
    scenes.push_back({{"scene", scene}, {"frames", frames}, {"instances", objects}});
    if (!options.json)
      std::printf("%s: %lld frames, %zu objects\n", scene.c_str(), static_cast<long long>(frames),
                  objects);
  }
  if (options.json)
    print_json(rooms.size() > 1 ? nlohmann::ordered_json{{"scenes", scenes}} : scenes[0]);
  return kDone;
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const char* set : {kApartmentsV1, kDesksV1})
    for (const BenchmarkScene& scene : benchmark_scenes(set)) names.push_back(scene.name);
  return names;
}

void add_walk_options(CLI::App& command, SynthOptions& options, CLI::Option* noise) {
  command
      .add_option("--plan", options.room.plan,
                  "instead of a room a walk through the rooms of a floor plan, OUT/its name: " +
                      listed(floor_plan_names()))
      ->excludes("--room")
      ->excludes("--frames");
  command
      .add_flag("--walk", options.walk,
                "a video instead: a camera carried through the room at walking pace, as its sensor "
                "sees it, with timestamps")
      ->excludes(noise)
      ->excludes("--frames");
  WalkConfig& video = options.video.walk;
  options.of_videos = {
      command.add_option("--fps", video.fps, "of a walk: frames a second")
          ->check(CLI::Range(1.0, 1000.0))
          ->capture_default_str(),
      command.add_option("--seconds", video.seconds, "of a walk: how long; 0: once round")
          ->check(CLI::Range(0.0, 1e5))
          ->capture_default_str(),
      command.add_option("--speed", video.speed_mps, "of a walk: metres a second")
          ->check(CLI::Range(0.05, 3.0))
          ->capture_default_str(),
      command
          .add_option("--whip", options.whip_deg_s,
                      "of a walk: every few seconds a pan aside and back, up to so many degrees a "
                      "second")
          ->check(CLI::Range(0.0, 1000.0)),
      command.add_flag(
          "--gyroscope", options.gyroscope,
          "of a walk: beside the frames what the camera's gyroscope measures, with its "
          "noise and offset, as gyroscope.txt"),
      command.add_flag("--exact", options.exact, "of a walk: exact frames, as of no real sensor")};
}

}  // namespace

Action add_synth(CLI::App& command) {
  auto options = std::make_shared<SynthOptions>();
  command
      .add_option("OUT", options->out,
                  "folder to write; the recording is OUT/room, a walk OUT/its room's name")
      ->required();
  command
      .add_option(
          "--room", options->room.room,
          concat("which room: ", listed(room_names()), "; or a benchmark, each scene OUT/its ",
                 "name: ", kRoomsV1, ", ", kApartmentsV1, " or ", kDesksV1,
                 ", whose scenes can be named too: ", listed(scene_names())))
      ->capture_default_str();
  command
      .add_option("--frames", options->room.frames,
                  "number of frames, far apart, from all sides; 0: as the room says")
      ->check(CLI::Range(0, 1000000));
  command.add_option("--seed", options->room.seed, "another seed gives another room of the kind")
      ->capture_default_str();
  auto* noise = command.add_flag("--noise", options->room.frames_as.noise,
                                 "as a depth camera sees it: noise, quantisation, holes");
  add_walk_options(command, *options, noise);
  command
      .add_option(
          "--visits", options->visits,
          "so many visits to the room, OUT/visit1, OUT/visit2, ...: things move, go and come, and "
          "doors of flats turn in between; OUT/changes.json tells which")
      ->check(CLI::Range(1, 1000));
  command.add_flag("--figure", options->figure,
                   "somebody walks through with a carton in the hands, in every visit");
  command.add_option("--size", options->size, "WIDTHxHEIGHT of the frames; else as the room says");
  auto* catalog = command.add_flag(
      "--catalog", options->catalog,
      "instead of a room: pictures of every furniture model by itself, OUT/crops and crops.csv");
  command.add_option("--views", options->views, "with --catalog: pictures of a model")
      ->check(CLI::Range(1, 10000))
      ->needs(catalog)
      ->capture_default_str();
  command
      .add_option("--furniture", options->room.furniture, "folder of .sh3f furniture catalogues")
      ->capture_default_str();
  command
      .add_option(
          "--models", options->room.models,
          "of a room: JSON with the catalogue ids to draw from, {\"chair\": [\"Scopia/chair3\"]}; "
          "pieces of other classes are left out")
      ->check(CLI::ExistingFile);
  command
      .add_option(
          "--set", options->settings,
          "one setting of how frames are made, as sensor.sigma_base_m=0.003; may be repeated")
      ->type_size(1)
      ->allow_extra_args(false);
  command.add_option("--threads", options->threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return synth(*options); };
}

}  // namespace ovimap::apps
