// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "find_start.h"

#include <chrono>
#include <optional>

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

/// The first frames that are pushed, which stay where they wait.
std::vector<Frame> first_pushed(FrameIntake& intake, int count) {
  constexpr std::chrono::milliseconds kLook{50};  // between looks at what was interrupted
  std::optional<std::vector<Frame>> first;
  while (!(first = intake.peek(static_cast<std::size_t>(count), kLook)))
    if (interrupted()) intake.finish();
  return std::move(*first);
}

/// nullopt: none came, and so the run will be empty.
std::optional<VisitFit> fit_pushed(const VoxelMap& map, FrameIntake& intake,
                                   const ProgramConfig& config) {
  const std::vector<Frame> first = first_pushed(intake, config.visit.frames);
  if (first.empty()) return std::nullopt;
  VisitFitter fitter(map, config.track, config.visit);
  for (const Frame& frame : first) fitter.add(frame);
  return fitter.fit();
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

void require_fit(const MapDocument& begun, const MappingInputs& inputs, FrameIntake* intake) {
  const ProgramConfig& config = inputs.config;
  if (!config.visit.enabled || inputs.tracking) return;
  const std::optional<VisitFit> fit =
      intake ? fit_pushed(begun.map, *intake, config)
             : fit_visit(begun.map, *inputs.source, inputs.range, config.track, config.visit);
  const std::string fault = fit ? misfit(*fit, config.visit) : "";
  if (!fault.empty())
    throw Error(concat("the recording does not fit the map, which stays as it was: ", fault,
                       "; map it by itself and bring the two together with `ovimap merge --align`, "
                       "or give poses in the map's world frame"));
}

void require_same_recording(const MapDocument& begun, const MappingInputs& inputs,
                            const std::vector<std::int64_t>& done) {
  if (!inputs.config.visit.enabled || inputs.tracking || !inputs.source || done.empty()) return;
  const VisitFitConfig& config = inputs.config.visit;
  const std::string fault =
      misfit(fit_visit(begun.map, *inputs.source, done, inputs.config.track, config), config);
  if (!fault.empty())
    throw Error(concat("the map was made of another recording, for this one does not fit it: ",
                       fault, "; --resume goes on with the same one, --continue with the place"));
}

}  // namespace ovimap::apps
