// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "synth_room.h"

#include <nlohmann/json.hpp>

#include "apps/command/box_json.h"
#include "ovimap/base/bounded_json.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/truth/replica_pack.h"
#include "ovimap/synth/buildings/benchmark_scenes.h"
#include "ovimap/synth/buildings/floor_plan.h"
#include "ovimap/synth/buildings/room_builder.h"
#include "ovimap/synth/buildings/visits.h"
#include "ovimap/synth/furniture/furniture_palette.h"
#include "ovimap/synth/recordings/little_seen.h"
#include "ovimap/synth/rooms/rooms_v1.h"

namespace ovimap::apps {

namespace {

constexpr std::size_t kMostModelBytes = 1 << 20;
constexpr int kPlanWidth_px = 640, kPlanHeight_px = 480;

PinholeCamera camera_of(const RoomOptions& options) {
  if (options.width > 0) return synth_camera(options.width, options.height);
  return options.scene || !options.plan.empty() ? synth_camera(kPlanWidth_px, kPlanHeight_px)
                                                : room_spec(options.room, options.seed).camera;
}

ModelChoice read_models(const std::filesystem::path& path) {
  ModelChoice models;
  try {
    models = read_json(path, kMostModelBytes).get<ModelChoice>();
  } catch (const nlohmann::json::exception&) {
    throw Error(concat("models ", path.string(), ": expected lists of catalogue ids by class, as ",
                       R"({"chair": ["Scopia/chair3"]})"));
  }
  for (const auto& [class_name, ids] : models) {
    room_class_id(class_name);
    if (ids.empty()) throw Error(concat("models ", path.string(), ": no model of ", class_name));
  }
  return models;
}

SynthRoom make_room(const RoomOptions& options) {
  if (!options.models.empty() && (options.scene || !options.plan.empty()))
    throw Error(
        "--models is of a room; places of benchmarks and plans have furniture of their own");
  if (options.scene) return build_benchmark_scene(*options.scene, options.seed, options.furniture);
  if (!options.plan.empty())
    return build_plan(floor_plan(options.plan, options.seed), options.furniture);
  RoomSpec spec = room_spec(options.room, options.seed);
  if (!options.models.empty()) spec.models = read_models(options.models);
  return build_room(spec, options.furniture);
}

SynthSequence make_sequence(SynthRoom room, const RoomOptions& options) {
  const SynthSequenceConfig& config = options.frames_as;
  const PinholeCamera camera = camera_of(options);
  if (options.video) return {std::move(room), camera, *options.video, config};
  const int frames =
      options.frames > 0 ? options.frames : room_spec(options.room, options.seed).frames;
  return {std::move(room), camera, frames, config};
}

WrittenRoom write_sequence(
    const std::filesystem::path& out, const RoomOptions& options, SynthRoom room,
    const std::string& scene,
    const std::function<void(std::int64_t done, std::int64_t total)>& progress) {
  const SynthSequence sequence = make_sequence(std::move(room), options);
  ReplicaPack pack;
  pack.scene = scene;
  pack.frames = &sequence;
  pack.truth = sequence.truth_mesh();
  if (options.scene) pack.unscored = little_seen(sequence, pack.truth);
  pack.timed = sequence.is_video();
  pack.notice = sequence.notice();
  pack.settings = sequence.settings();
  for (const TruthInstance& instance : sequence.instances())
    pack.instances.push_back(
        {instance.id, instance.class_id, instance.class_name, instance.room, instance.substance});
  write_replica_pack(out, pack, {}, progress);
  if (const std::vector<TurnRate> rates = sequence.turn_rates(); !rates.empty())
    write_text(out / scene / kGyroscopeFile, gyroscope_text(rates));
  return {(out / scene).string(), sequence.size(), pack.instances.size(), sequence.moving()};
}

nlohmann::ordered_json change_json(std::size_t visit, const RoomChange& change,
                                   const RoomObject& object) {
  constexpr const char* kKinds[] = {"moved", "removed", "added"};
  nlohmann::ordered_json json = {{"visit", visit},
                                 {"object", change.object},
                                 {"name", object.name},
                                 {"class", object.class_name},
                                 {"kind", kKinds[static_cast<int>(change.kind)]},
                                 {"from", box_json<nlohmann::ordered_json>(change.from)},
                                 {"to", box_json<nlohmann::ordered_json>(change.to)}};
  if (change.kind != RoomChangeKind::kMoved) return json;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      json["new_from_old"].push_back(change.new_from_old.matrix()(row, column));
  return json;
}

}  // namespace

WrittenRoom write_room(const std::filesystem::path& out, const RoomOptions& options,
                       const std::string& scene,
                       const std::function<void(std::int64_t done, std::int64_t total)>& progress) {
  return write_sequence(out, options, make_room(options), scene, progress);
}

std::vector<WrittenRoom> write_visits(
    const std::filesystem::path& out, const RoomOptions& options, int visits,
    const std::function<void(std::int64_t done, std::int64_t total)>& progress) {
  const SynthRoom room = make_room(options);
  nlohmann::ordered_json truth = {{"visits", nlohmann::ordered_json::array()},
                                  {"changes", nlohmann::ordered_json::array()}};
  std::vector<WrittenRoom> written;
  for (Visit& visit : plan_visits(room, visits)) {
    const std::size_t number = written.size() + 1;
    const std::string scene = concat("visit", number);
    truth["visits"].push_back(scene);
    for (const RoomChange& change : visit.changes)
      truth["changes"].push_back(change_json(number, change, room.objects[change.object - 1u]));
    written.push_back(write_sequence(
        out, options, std::move(visit.room), scene, [&](std::int64_t done, std::int64_t frames) {
          const auto before = static_cast<std::int64_t>(number - 1) * frames;
          if (progress) progress(before + done, visits * frames);
        }));
    for (const std::uint32_t id : written.back().moving)
      truth["moving"].push_back({{"visit", number}, {"object", id}});
  }
  write_text(out / "changes.json", truth.dump(1) + "\n");
  return written;
}

}  // namespace ovimap::apps
