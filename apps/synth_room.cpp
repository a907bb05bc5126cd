// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "synth_room.h"

#include "ovimap/io/replica_pack.h"
#include "ovimap/synth/room_builder.h"
#include "ovimap/synth/sequence.h"

namespace ovimap::apps {

WrittenRoom write_room(const std::filesystem::path& out, const RoomOptions& options,
                       const std::string& scene,
                       const std::function<void(std::int64_t done, std::int64_t total)>& progress) {
  const RoomSpec spec = room_spec(options.room, options.seed);
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
  write_replica_pack(out, pack, {}, progress);
  return {(out / scene).string(), sequence.size(), pack.instances.size()};
}

}  // namespace ovimap::apps
