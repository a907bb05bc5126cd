// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "command.h"
#include "ovimap/base/parallel.h"
#include "ovimap/io/replica_pack.h"
#include "ovimap/synth/room_builder.h"
#include "ovimap/synth/sequence.h"
#include "synth_catalog.h"

namespace ovimap::apps {

namespace {

struct SynthOptions {
  std::filesystem::path out, furniture = default_furniture_folder();
  std::string room = "tiny";
  int frames = 0;
  std::uint64_t seed = 1;
  bool noise = false;
  bool catalog = false;
  int views = PortraitConfig{}.views;
  int threads = 0;
  bool json = false;
};

struct WrittenRoom {
  std::string scene;
  std::int64_t frames = 0;
  std::size_t objects = 0;
};

WrittenRoom write_room(const SynthOptions& options, const std::string& room,
                       const std::string& scene) {
  const RoomSpec spec = room_spec(room, options.seed);
  SynthSequenceConfig config;
  config.noise = options.noise;
  const SynthSequence sequence(build_room(spec, options.furniture), spec.camera,
                               options.frames > 0 ? options.frames : spec.frames, config);
  ReplicaPack pack;
  pack.scene = scene;
  pack.frames = &sequence;
  pack.truth = sequence.truth_mesh();
  pack.notice = sequence.notice();
  pack.settings = sequence.settings();
  for (const TruthInstance& instance : sequence.instances())
    pack.instances.push_back({instance.id, instance.class_id, instance.class_name});
  Progress progress("rendering " + room);
  write_replica_pack(options.out, pack, {}, [&](std::int64_t done, std::int64_t total) {
    progress.show(static_cast<std::size_t>(done), static_cast<std::size_t>(total));
  });
  return {(options.out / scene).string(), sequence.size(), pack.instances.size()};
}

int synth(const SynthOptions& options) {
  const ThreadLimit limit(options.threads);
  if (options.catalog)
    return synth_catalog(
        {options.out, options.furniture, options.views, options.seed, options.json});
  std::vector<WrittenRoom> rooms;
  if (options.room == kRoomsV1)
    for (const std::string& name : rooms_v1_names())
      rooms.push_back(write_room(options, name, name));
  else
    rooms.push_back(write_room(options, options.room, "room"));
  nlohmann::ordered_json scenes = nlohmann::ordered_json::array();
  for (const auto& [scene, frames, objects] : rooms) {
    scenes.push_back({{"scene", scene}, {"frames", frames}, {"instances", objects}});
    if (!options.json)
      std::printf("%s: %lld frames, %zu objects\n", scene.c_str(), static_cast<long long>(frames),
                  objects);
  }
  if (options.json)
    print_json(options.room == kRoomsV1 ? nlohmann::ordered_json{{"scenes", scenes}} : scenes[0]);
  return kDone;
}

}  // namespace

Action add_synth(CLI::App& command) {
  auto options = std::make_shared<SynthOptions>();
  std::string rooms;
  for (const std::string& name : room_names()) rooms += (rooms.empty() ? "" : ", ") + name;
  command.add_option("OUT", options->out, "folder to write; the recording is OUT/room")->required();
  command
      .add_option("--room", options->room,
                  concat("which room: ", rooms, "; or ", kRoomsV1,
                         ", the five of the benchmark, each OUT/its name"))
      ->capture_default_str();
  command.add_option("--frames", options->frames, "number of frames; 0: as the room says")
      ->check(CLI::Range(0, 1000000));
  command.add_option("--seed", options->seed, "another seed gives another room of the kind")
      ->capture_default_str();
  command.add_flag("--noise", options->noise,
                   "as a depth camera sees it: noise, quantisation, holes");
  auto* catalog = command.add_flag(
      "--catalog", options->catalog,
      "instead of a room: pictures of every furniture model by itself, OUT/crops and crops.csv");
  command.add_option("--views", options->views, "with --catalog: pictures of a model")
      ->check(CLI::Range(1, 10000))
      ->needs(catalog)
      ->capture_default_str();
  command.add_option("--furniture", options->furniture, "folder of .sh3f furniture catalogues")
      ->capture_default_str();
  command.add_option("--threads", options->threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return synth(*options); };
}

}  // namespace ovimap::apps
