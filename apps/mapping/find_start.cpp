// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "find_start.h"

#include "ovimap/pipeline/sequence/visit_start.h"

namespace ovimap::apps {

namespace {

std::vector<std::int64_t> first_of(const std::vector<std::int64_t>& positions, int count) {
  const auto end = std::min(std::ssize(positions), static_cast<std::ptrdiff_t>(count));
  return {positions.begin(), positions.begin() + end};
}

/// Where objects say that the recording lies in the map.
AlignmentSearch ask_objects(const MapDocument& map, MappingInputs& inputs) {
  const ProgramConfig& config = inputs.config;
  MapperConfig alone = config.mapper;
  alone.frame_store.max_mb = 0;
  alone.allow_still_camera = true;  // the recording as a whole moved
  Progress progress("looking for the recording's place");
  try {
    ObjectPlacing placing =
        place_by_objects(map, *inputs.source, first_of(inputs.range, config.visit.object_frames),
                         Mapper(alone, inputs.masks, inputs.encoder),
                         PoseFinder(Tracker(config.track), config.loops), config.visit.alignment,
                         [&](std::size_t done, std::size_t total, const FrameReport*) {
                           progress.show(done, total);
                           return !interrupted();
                         });
    inputs.finder->tracker().propose(std::move(placing.places));
    return placing.alignment;
  } catch (const Error& fault) {
    return {{}, fault.what()};  // the camera was lost there as well
  }
}

}  // namespace

void find_start(const MapDocument& begun, bool new_visit, MappingInputs& inputs) {
  const ProgramConfig& config = inputs.config;
  const std::vector<Keyframe>& keyframes = inputs.finder->tracker().keyframes();
  // Both maps must be in memory.
  const bool may_ask =
      new_visit && inputs.source && config.visit.object_frames > 0 && config.memory.max_mb == 0;
  if (may_ask &&
      !shows_known_place(*inputs.source, first_of(inputs.range, config.track.part_frames),
                         begun.map, keyframes, config.track))
    inputs.placing = ask_objects(begun, inputs);
  if (!keyframes.empty()) return;
  // A map of which only a part could be fused again keeps nothing.
  inputs.config.mapper.frame_store.max_mb = 0;
  if (!inputs.placing || !inputs.placing->doubt.empty())
    throw Error(
        concat("the map to go on with keeps no frames to find the camera's place by; map it "
               "with --set frame_store.max_mb=1000",
               inputs.placing ? concat(" (", inputs.placing->doubt, ")") : std::string()));
}

}  // namespace ovimap::apps
