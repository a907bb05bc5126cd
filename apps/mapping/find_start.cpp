// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "find_start.h"

#include <chrono>
#include <optional>

#include "ovimap/frames/frame/moved_source.h"
#include "ovimap/pipeline/search/history_dates.h"
#include "ovimap/pipeline/sequence/visit_start.h"

namespace ovimap::apps {

namespace {

std::vector<std::int64_t> first_of(const std::vector<std::int64_t>& positions, int count) {
  const auto end = std::min(std::ssize(positions), static_cast<std::ptrdiff_t>(count));
  return {positions.begin(), positions.begin() + end};
}

/// Both maps must be in memory.
bool may_ask_objects(const ProgramConfig& config) {
  return config.visit.object_frames > 0 && config.memory.max_mb == 0;
}

/// Where objects say that the recording lies in the map.
AlignmentSearch ask_objects(const MapDocument& map, MappingInputs& inputs) {
  const ProgramConfig& config = inputs.config;
  MapperConfig alone = config.mapper;
  alone.frame_store.max_mb = 0;
  alone.allow_still_camera = true;  // the recording as a whole moved
  Progress progress("looking for the recording's place");
  std::optional<PoseFinder> finder;
  if (inputs.tracking) finder.emplace(Tracker(config.track), config.loops);
  try {
    ObjectPlacing placing = place_by_objects(
        map, *inputs.source, first_of(inputs.range, config.visit.object_frames),
        Mapper(alone, inputs.masks, inputs.encoder), finder ? &*finder : nullptr,
        config.visit.alignment, [&](std::size_t done, std::size_t total, const FrameReport*) {
          progress.show(done, total);
          return !interrupted();
        });
    if (inputs.finder) inputs.finder->tracker().propose(std::move(placing.places));
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
  if (new_visit && inputs.source && may_ask_objects(config) &&
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

namespace {

VisitFit fit_of(const MapDocument& map, const MappingInputs& inputs,
                const std::vector<std::int64_t>& positions) {
  return fit_visit(map.map, *inputs.source, positions, inputs.config.track, inputs.config.visit);
}

}  // namespace

void align_recording(const MapDocument& map, MappingInputs& inputs) {
  if (inputs.tracking)
    throw Error(
        "--align is for recordings with poses; leave it away where the camera is tracked, "
        "which finds its place in the map by itself");
  const VisitFitConfig& config = inputs.config.visit;
  const VisitFit near = fit_of(map, inputs, inputs.range);
  if (misfit(near, config).empty()) return;
  auto owned = std::make_unique<MovedSource>(std::move(inputs.source));
  MovedSource& recording = *owned;
  inputs.source = std::move(owned);
  if (near.compared > 0) {  // the poses may be off by a little
    recording.move_to(near.map_from_recording);
    const VisitFit moved = fit_of(map, inputs, inputs.range);
    if (2 * moved.compared >= near.compared && misfit(moved, config).empty()) {
      inputs.map_from_recording = near.map_from_recording;
      return;
    }
    recording.move_to(Pose::Identity());
  }
  const AlignmentSearch placed =
      may_ask_objects(inputs.config)
          ? ask_objects(map, inputs)
          : AlignmentSearch{{},
                            "its frames do not, and objects are asked without a bound on "
                            "memory alone (--max-memory, visit.object_frames)"};
  if (!placed.doubt.empty())
    throw Error(concat("nothing says where the recording lies in the map, which stays as it was: ",
                       placed.doubt, "; give poses in the map's world frame"));
  recording.move_to(placed.best.a_from_b);
  inputs.map_from_recording =
      fit_of(map, inputs, inputs.range).map_from_recording * placed.best.a_from_b;
  recording.move_to(*inputs.map_from_recording);
}

void require_fit(const MapDocument& begun, const MappingInputs& inputs, FrameIntake* intake) {
  const ProgramConfig& config = inputs.config;
  if (!config.visit.enabled || inputs.tracking) return;
  const std::optional<VisitFit> fit =
      intake ? fit_pushed(begun.map, *intake, config) : fit_of(begun, inputs, inputs.range);
  const std::string fault = fit ? misfit(*fit, config.visit) : "";
  if (!fault.empty())
    throw Error(concat("the recording does not fit the map, which stays as it was: ", fault,
                       intake ? "; map it by itself and bring the two together with `ovimap merge "
                                "--align`, "
                              : "; move it there with --align, ",
                       "or give poses in the map's world frame"));
}

void require_later(const MapRecord& begun, std::optional<double> recorded_s,
                   const MappingInputs& inputs) {
  if (!recorded_s && inputs.source && !inputs.range.empty()) {
    const FrameRead first = inputs.source->read(inputs.range.front());
    if (first.frame && is_date(first.frame->timestamp_s)) recorded_s = first.frame->timestamp_s;
  }
  const HistoryDates dates(begun.history, begun.frames);
  const std::optional<double> last_s = dates.begin_of(dates.visits());
  if (recorded_s && last_s && *recorded_s < *last_s)
    throw Error(concat("the recording is of ", date_text(*recorded_s),
                       ", before the map's last visit, ", date_text(*last_s),
                       "; map visits in their order, or say with --recorded when this one was"));
}

void warn_of_known_recording(const MapRecord& begun, const std::string& source) {
  const auto& visits = begun.history.visits;
  const bool known = begun.source == source ||
                     std::any_of(visits.begin(), visits.end(),
                                 [&](const MapVisit& visit) { return visit.source == source; });
  if (known) warn(concat("'", source, "' is in the map already; it is taken for another visit"));
}

void require_same_recording(const MapDocument& begun, const MappingInputs& inputs,
                            const std::vector<std::int64_t>& done) {
  if (!inputs.config.visit.enabled || inputs.tracking || !inputs.source || done.empty()) return;
  const std::string fault = misfit(fit_of(begun, inputs, done), inputs.config.visit);
  if (!fault.empty())
    throw Error(
        concat("the map was made of another recording, for this one does not fit it: ", fault,
               "; --resume goes on with the same one and the same options (--align), "
               "--continue with the place"));
}

}  // namespace ovimap::apps
