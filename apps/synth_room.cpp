// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "synth_room.h"

#include "ovimap/io/truth/replica_pack.h"
#include "ovimap/synth/buildings/benchmark_scenes.h"
#include "ovimap/synth/buildings/floor_plan.h"
#include "ovimap/synth/buildings/room_builder.h"
#include "ovimap/synth/recordings/little_seen.h"
#include "ovimap/synth/rooms/rooms_v1.h"

namespace ovimap::apps {

namespace {

constexpr int kPlanWidth_px = 640, kPlanHeight_px = 480;

SynthSequence make_sequence(const RoomOptions& options) {
  if (options.scene) {
    SynthSequenceConfig config;
    config.noise = options.noise;
    const PinholeCamera camera = options.width > 0 ? synth_camera(options.width, options.height)
                                                   : synth_camera(kPlanWidth_px, kPlanHeight_px);
    return {build_benchmark_scene(*options.scene, options.seed, options.furniture), camera,
            *options.video, config};
  }
  const bool plan = !options.plan.empty();
  const RoomSpec spec = room_spec(plan ? "bare" : options.room, options.seed);
  PinholeCamera camera = plan ? synth_camera(kPlanWidth_px, kPlanHeight_px) : spec.camera;
  if (options.width > 0) camera = synth_camera(options.width, options.height);
  SynthSequenceConfig config;
  config.noise = options.noise;
  SynthRoom room = plan ? build_plan(floor_plan(options.plan, options.seed), options.furniture)
                        : build_room(spec, options.furniture);
  if (options.video) return {std::move(room), camera, *options.video, config};
  return {std::move(room), camera, options.frames > 0 ? options.frames : spec.frames, config};
}

}  // namespace

WrittenRoom write_room(const std::filesystem::path& out, const RoomOptions& options,
                       const std::string& scene,
                       const std::function<void(std::int64_t done, std::int64_t total)>& progress) {
  const SynthSequence sequence = make_sequence(options);
  ReplicaPack pack;
  pack.scene = scene;
  pack.frames = &sequence;
  pack.truth = sequence.truth_mesh();
  if (options.scene) pack.unscored = little_seen(sequence, pack.truth);
  pack.timed = sequence.is_video();
  pack.notice = sequence.notice();
  pack.settings = sequence.settings();
  for (const TruthInstance& instance : sequence.instances())
    pack.instances.push_back({instance.id, instance.class_id, instance.class_name, instance.room});
  write_replica_pack(out, pack, {}, progress);
  return {(out / scene).string(), sequence.size(), pack.instances.size()};
}

}  // namespace ovimap::apps
