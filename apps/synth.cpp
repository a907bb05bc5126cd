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

int synth(const SynthOptions& options) {
  const ThreadLimit limit(options.threads);
  if (options.catalog)
    return synth_catalog(
        {options.out, options.furniture, options.views, options.seed, options.json});
  const RoomSpec spec = room_spec(options.room, options.seed);
  SynthSequenceConfig config;
  config.noise = options.noise;
  const SynthSequence sequence(build_room(spec, options.furniture), spec.camera,
                               options.frames > 0 ? options.frames : spec.frames, config);
  ReplicaPack pack;
  pack.scene = "room";
  pack.frames = &sequence;
  pack.truth = sequence.truth_mesh();
  pack.notice = sequence.notice();
  pack.settings = sequence.settings();
  for (const TruthInstance& instance : sequence.instances())
    pack.instances.push_back({instance.id, instance.class_id, instance.class_name});
  {
    Progress progress("rendering");
    write_replica_pack(options.out, pack, {}, [&](std::int64_t done, std::int64_t total) {
      progress.show(static_cast<std::size_t>(done), static_cast<std::size_t>(total));
    });
  }
  const std::string scene = (options.out / pack.scene).string();
  if (options.json)
    print_json(
        {{"scene", scene}, {"frames", sequence.size()}, {"instances", pack.instances.size()}});
  else
    std::printf("%s: %lld frames, %zu objects\n", scene.c_str(),
                static_cast<long long>(sequence.size()), pack.instances.size());
  return kDone;
}

}  // namespace

Action add_synth(CLI::App& command) {
  auto options = std::make_shared<SynthOptions>();
  std::string rooms;
  for (const std::string& name : room_names()) rooms += (rooms.empty() ? "" : ", ") + name;
  command.add_option("OUT", options->out, "folder to write; the recording is OUT/room")->required();
  command.add_option("--room", options->room, "which room: " + rooms)->capture_default_str();
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
