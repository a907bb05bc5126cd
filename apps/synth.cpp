// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "command.h"
#include "ovimap/base/parallel.h"
#include "ovimap/synth/room_spec.h"
#include "synth_catalog.h"
#include "synth_room.h"

namespace ovimap::apps {

namespace {

struct SynthOptions {
  std::filesystem::path out;
  RoomOptions room;
  bool catalog = false;
  int views = PortraitConfig{}.views;
  int threads = 0;
  bool json = false;
};

WrittenRoom render(const SynthOptions& options, const std::string& room, const std::string& scene) {
  RoomOptions chosen = options.room;
  chosen.room = room;
  Progress progress("rendering " + room);
  return write_room(options.out, chosen, scene, [&](std::int64_t done, std::int64_t total) {
    progress.show(static_cast<std::size_t>(done), static_cast<std::size_t>(total));
  });
}

int synth(const SynthOptions& options) {
  const ThreadLimit limit(options.threads);
  if (options.catalog)
    return synth_catalog(
        {options.out, options.room.furniture, options.views, options.room.seed, options.json});
  std::vector<WrittenRoom> rooms;
  if (options.room.room == kRoomsV1)
    for (const std::string& name : rooms_v1_names()) rooms.push_back(render(options, name, name));
  else
    rooms.push_back(render(options, options.room.room, "room"));
  nlohmann::ordered_json scenes = nlohmann::ordered_json::array();
  for (const auto& [scene, frames, objects] : rooms) {
    scenes.push_back({{"scene", scene}, {"frames", frames}, {"instances", objects}});
    if (!options.json)
      std::printf("%s: %lld frames, %zu objects\n", scene.c_str(), static_cast<long long>(frames),
                  objects);
  }
  if (options.json)
    print_json(options.room.room == kRoomsV1 ? nlohmann::ordered_json{{"scenes", scenes}}
                                             : scenes[0]);
  return kDone;
}

}  // namespace

Action add_synth(CLI::App& command) {
  auto options = std::make_shared<SynthOptions>();
  std::string rooms;
  for (const std::string& name : room_names()) rooms += (rooms.empty() ? "" : ", ") + name;
  command.add_option("OUT", options->out, "folder to write; the recording is OUT/room")->required();
  command
      .add_option("--room", options->room.room,
                  concat("which room: ", rooms, "; or ", kRoomsV1,
                         ", the five of the benchmark, each OUT/its name"))
      ->capture_default_str();
  command.add_option("--frames", options->room.frames, "number of frames; 0: as the room says")
      ->check(CLI::Range(0, 1000000));
  command.add_option("--seed", options->room.seed, "another seed gives another room of the kind")
      ->capture_default_str();
  command.add_flag("--noise", options->room.noise,
                   "as a depth camera sees it: noise, quantisation, holes");
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
  command.add_option("--threads", options->threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return synth(*options); };
}

}  // namespace ovimap::apps
