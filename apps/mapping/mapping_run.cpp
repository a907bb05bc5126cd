// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "mapping_run.h"

#include <algorithm>
#include <future>

#include "apps/command/same_settings.h"
#include "find_start.h"
#include "ovimap/base/thread_priority.h"
#include "ovimap/io/map_file/map_checkpoint.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/map/fusion/past_evidence.h"
#include "ovimap/pipeline/revise/visit_history.h"

namespace ovimap::apps {

namespace {

/// The settings that made the map, with what the command line chose beside them.
std::string effective_config(ProgramConfig config, const MappingOptions& options,
                             const MapperConfig& mapper,
                             const std::shared_ptr<ImageTextEncoder>& encoder) {
  config.mapper = mapper;
  ConfigFields fields;
  list_fields(config, fields);
  return concat("# preset ", options.preset, ", masks ", options.masks, ", encoder ",
                encoder ? encoder->identity().name : "none", ", frames ", options.frames, "\n",
                fields.dump());
}

/// What a run goes on with, and where its checkpoints go.
struct BegunRun {
  std::optional<MapDocument> document;
  std::shared_ptr<TileKeeper> tiles;  ///< null: nowhere
  bool new_visit = false;             ///< the recording is another than those of the document
};

/// A new map in the place of one that people corrected would lose what they did.
void refuse_to_replace_corrections(const RunTarget& target) {
  if (target.resume || !replaces_a_map(target)) return;
  const std::size_t corrections = effective_edits(read_edits(target.map)).size();
  if (corrections > 0)
    throw Error(concat("'", target.map.string(), "' has ", corrections,
                       corrections == 1 ? " correction" : " corrections",
                       " that a new map in its place would lose; go on with it (--continue), write "
                       "to another file with -o, or delete it"));
}

BegunRun find_begun(const RunTarget& target, const MemoryConfig& memory) {
  BegunRun begun;
  if (target.map.empty()) {
    if (memory.max_mb > 0)
      throw Error("memory.max_mb is for `run` and `bench`; leave it away or set it to 0");
    return begun;
  }
  refuse_to_replace_corrections(target);
  const std::filesystem::path partial = checkpoint_path(target.map);
  const bool unfinished = holds_checkpoint(partial);
  if (unfinished && !target.resume)
    throw Error(concat("an unfinished run left '", partial.string(), "' with ",
                       read_map_info(partial).frames,
                       " frames; --resume goes on with it, or delete it to begin anew"));
  if (unfinished) require_own_checkpoint(partial);
  begun.tiles = std::make_shared<TileKeeper>(
      partial, unfinished ? TileKeeper::Start::kGoOn : TileKeeper::Start::kAnew, memory);
  const bool finished =
      target.resume && target.map != target.continued && std::filesystem::exists(target.map);
  begun.new_visit = !unfinished && !finished && !target.continued.empty();
  if (unfinished || finished)
    begun.document = load_map_in(begun.tiles, unfinished ? partial : target.map);
  else if (begun.new_visit)
    begun.document = load_map_in(begun.tiles, target.continued);
  const bool visit_under_way =
      begun.document && begun.document->unfinished && begun.document->history.visits.size() > 1;
  if (visit_under_way && target.continued.empty())
    throw Error(concat("the unfinished run of '", partial.string(),
                       "' goes on with a map; name it by --continue as that run did"));
  return begun;
}

/// Takes frames that are in the map already out of those that are left, and returns them.
std::vector<std::int64_t> take_done(std::vector<std::int64_t>& left, const MapRecord& begun) {
  if (begun.frames.empty()) return {};
  const std::int64_t first =
                         begun.history.visits.empty() ? 0 : begun.history.visits.back().first_index,
                     last = begun.frames.back().index;
  const auto not_done = std::stable_partition(
      left.begin(), left.end(), [&](std::int64_t position) { return first + position <= last; });
  std::vector<std::int64_t> done(left.begin(), not_done);
  left.erase(left.begin(), not_done);
  return done;
}

/// Gives `mapper`, a Mapper or a LiveMapper, what an earlier run had, and `header` what people told
/// that run's map, which no run finds anew; returns its frames. `intake`: where frames are pushed.
template <class AnyMapper>
SequenceResult resume(BegunRun& begun, MapHeader& header, MappingInputs& inputs, AnyMapper& mapper,
                      FrameIntake* intake = nullptr) {
  SequenceResult sequence;
  if (!begun.document) return sequence;
  if (begun.new_visit) {
    require_fit(*begun.document, inputs, intake);
    if (!intake) warn_of_known_recording(*begun.document, header.source);
    begin_visit(*begun.document, inputs.config.visit.past, header);
  } else {
    require_same_source(*begun.document, header.source);
    require_same_settings(begun.document->config_text, header.config_text, "--resume");
    header.history = begun.document->history;
    require_same_recording(*begun.document, inputs, take_done(inputs.range, *begun.document));
  }
  header.names = begun.document->names;
  header.edits = begun.document->edits;
  sequence.frames = begun.document->frames;
  sequence.depth_camera = begun.document->depth_camera;
  if (intake && !sequence.frames.empty())  // another visit may have another camera
    intake->resume_at(
        sequence.frames.back().index + 1,
        begun.new_visit ? std::nullopt : std::optional<PinholeCamera>(sequence.depth_camera));
  mapper.restore(std::move(*begun.document));
  const auto& visits = header.history.visits;
  if (!inputs.source || visits.empty()) return sequence;  // pushed frames have the map's numbers
  mapper.number_from(visits.back().first_index);
  if (inputs.finder) inputs.finder->tracker().number_from(visits.back().first_index);
  return sequence;
}

/// Null where there are none. Loops that are closed meanwhile let its tiles leave.
std::unique_ptr<Checkpointer> make_checkpointer(const BegunRun& begun, const MappingInputs& inputs,
                                                const MapHeader& header, std::size_t frames_done) {
  if (!begun.tiles) return nullptr;
  auto checkpoints =
      std::make_unique<Checkpointer>(begun.tiles, inputs.config.checkpoint, header, frames_done);
  if (inputs.finder)
    inputs.finder->before_correction = [to = checkpoints.get()](Mapper& map) {
      to->let_tiles_leave(map);
    };
  return checkpoints;
}

MapHeader make_header(const MappingInputs& inputs, const MappingOptions& options,
                      const MapperConfig& mapper) {
  MapHeader header{(inputs.source ? inputs.source->kind() + ":" : "") + options.source,
                   effective_config(inputs.config, options, mapper, inputs.encoder)};
  if (options.recorded_s) header.history.visits = {{header.source, 0, 0, options.recorded_s}};
  return header;
}

/// Finds the poses of a run that has none, at home in what the run goes on with; else null.
std::shared_ptr<PoseFinder> make_finder(const MappingInputs& inputs, const BegunRun& begun) {
  if (!inputs.tracking) return nullptr;
  Tracker tracker(inputs.config.track);
  if (begun.document && !begun.document->frames.empty())
    tracker.begin_in(keyframes_of(begun.document->frames, begun.document->kept_frames,
                                  begun.document->depth_camera, inputs.config.track.keyframes));
  return std::make_shared<PoseFinder>(std::move(tracker), inputs.config.loops);
}

/// Begins the search for the camera in what the run goes on with; throws Error where that has other
/// voxels or embeddings, before anything that takes long.
void begin_in(const BegunRun& begun, const MappingOptions& options, const RunTarget& target,
              MappingInputs& inputs) {
  inputs.finder = make_finder(inputs, begun);
  if (!begun.document) return;
  if (begun.new_visit) {
    require_later(*begun.document, options.recorded_s, inputs);
    require_same_map(*begun.document, inputs.config.mapper.map, inputs.encoder);
  } else {
    require_same_encoder(begun.document->semantics.encoder, inputs.encoder);
  }
  if (target.align && begun.new_visit) align_recording(*begun.document, inputs);
  if (target.align && !begun.new_visit)  // resumed: it finds the same again in what was before
    align_recording(load_map(target.continued), inputs);
  if (inputs.finder && !begun.document->frames.empty())
    find_start(*begun.document, begun.new_visit, inputs);
}

/// What tracking did; where the camera came by a place again, the map's loops are closed.
TrackingRun finish_tracking(const PoseFinder& finder, const ProgramConfig& config, Mapper& mapper,
                            SequenceResult& sequence) {
  const auto& log = finder.tracker().log();
  TrackingRun tracking{summarise(log),
                       finder.corrections(),
                       {},
                       unknown_places(log, config.track.part_frames),
                       sensor_doubts(finder.tracker()),
                       {}};
  if (config.track.part_frames == 0) tracking.unknown.clear();
  Progress progress("closing loops");
  tracking.loops =
      close_last_loops(mapper, sequence.frames, sequence.depth_camera, config.track, config.loops,
                       [&](std::size_t done, std::size_t total) { progress.show(done, total); });
  return tracking;
}

/// A file of voxels beside the checkpoint, for as long as it is in use.
std::shared_ptr<TileKeeper> tiles_beside(std::filesystem::path checkpoint, const char* ending,
                                         const MemoryConfig& memory) {
  auto tiles = std::make_shared<TileKeeper>(checkpoint += ending, TileKeeper::Start::kAnew, memory);
  tiles->remove();  // when it is closed
  return tiles;
}

/// What the visit changed. The map, what it was before and what the visit saw share a bound on
/// memory.
void tell_visit(const RunTarget& target, const MemoryConfig& memory, const PastEvidenceConfig& past,
                TileKeeper& tiles, MapDocument& after) {
  const MemoryConfig third{(memory.max_mb + 2) / 3};
  tiles.set_bound(third);
  MapDocument before = load_map_in(tiles_beside(tiles.path(), ".before", third), target.continued);
  discount_past(before.map, past);
  const auto seen = third.max_mb > 0 ? tiles_beside(tiles.path(), ".seen", third) : nullptr;
  ovimap::tell_visit(before, after, {}, seen);
}

MappingRun finished_run(MappingInputs&& inputs, MapHeader header, Mapper&& mapper,
                        SequenceResult sequence, std::unique_ptr<Checkpointer> checkpoints,
                        const RunTarget& target, TileKeeper* tiles) {
  MappingRun run;
  if (checkpoints && inputs.tracking)  // who kills the closing of loops leaves all frames mapped
    checkpoints->store(mapper, sequence.frames, sequence.depth_camera);
  if (checkpoints) checkpoints->let_tiles_leave(mapper);
  if (inputs.finder)
    run.tracking = finish_tracking(*inputs.finder, inputs.config, mapper, sequence);
  if (inputs.finder) run.tracking->placing = std::move(inputs.placing);
  run.map_from_recording = inputs.map_from_recording;
  run.source = std::move(inputs.source);
  run.masks_wanted = inputs.masks != nullptr;
  run.masks_seen = mapper.masks_seen();
  if (inputs.people) run.people_frames = inputs.people->frames_with_people();
  run.sequence = std::move(sequence);
  mapper.finish();
  if (checkpoints) checkpoints->report(mapper.timers());
  run.timers = mapper.timers();
  run.document = make_document(std::move(mapper), run.sequence, std::move(header));
  if (inputs.keeps_for_loops) run.document.kept_frames.clear();
  run.checkpoints = std::move(checkpoints);
  if (!target.continued.empty())
    tell_visit(target, inputs.config.memory, inputs.config.visit.past, *tiles, run.document);
  return run;
}

/// A live run that is to be done again.
struct RepeatedRun {
  std::string title;  ///< the line of its configuration that says how live it was
  std::vector<LiveStep> steps;
};

/// Throws Error when the map of `target.repeated` cannot be made again, or not with the settings
/// that `header` has.
RepeatedRun find_repeated(const RunTarget& target, const MapHeader& header, bool tracked,
                          const std::shared_ptr<ImageTextEncoder>& encoder) {
  MapRecord live = load_map_without_voxels(target.repeated);
  if (live.history.visits.size() > 1)
    throw Error("the map cannot be made again: it is of several visits");
  require_repeatable(live.live_steps, tracked);
  require_same_settings(live.config_text, header.config_text, "--repeat");
  require_same_encoder(live.semantics.encoder, encoder);
  std::string title = live.config_text.substr(0, live.config_text.find('\n') + 1);
  return {std::move(title), std::move(live.live_steps)};
}

/// Ctrl-C ends a live run twice: its frames, and then the masks that are to come.
constexpr int kEndsOfALiveRun = 2;

class LiveProgressBar {
 public:
  bool operator()(std::size_t count, std::size_t total) {
    bar_->show(count, total, stopped_ ? "finding masks; Ctrl-C saves the map without" : "");
    if (stopped_) return !interrupted_again();
    stopped_ = interrupted();
    return !stopped_;
  }

 private:
  std::shared_ptr<Progress> bar_ = std::make_shared<Progress>("mapping live");
  bool stopped_ = false;
};

/// Frames come from `intake` or, where that is null, from the recording at a camera's pace.
LiveRunResult feed(LiveMapper& mapper, const MappingInputs& inputs, double fps,
                   FrameIntake* intake) {
  if (!intake) return run_live(*inputs.source, inputs.range, mapper, fps, LiveProgressBar());
  FrameFilter filter;
  if (inputs.people)
    filter = [&](Frame frame) { return inputs.people->without_people(std::move(frame)); };
  return run_pushed(*intake, mapper, LiveProgressBar(), filter);
}

}  // namespace

bool replaces_a_map(const RunTarget& target) {
  const bool goes_on = target.map == target.continued ||
                       (target.resume && !holds_checkpoint(checkpoint_path(target.map)));
  return !goes_on && std::filesystem::exists(target.map);
}

MappingRun map_recording(const MappingOptions& options, const std::string& title,
                         const std::filesystem::path& keep_masks, const RunTarget& target) {
  MappingInputs inputs(options);
  BegunRun begun = find_begun(target, inputs.config.memory);
  inputs.open_networks(options, keep_masks);
  watch_for_interrupt();
  begin_in(begun, options, target, inputs);
  const auto finder = inputs.finder;
  Mapper mapper(inputs.config.mapper, inputs.masks, inputs.encoder);
  mapper.recognize_with(inputs.recognizer);
  MapHeader header = make_header(inputs, options, mapper.config());
  SequenceResult sequence = resume(begun, header, inputs, mapper);
  const std::size_t frames_before = sequence.frames.size();
  auto checkpoints = make_checkpointer(begun, inputs, header, sequence.frames.size());
  {
    Progress progress(title);
    sequence = run_sequence(
        *inputs.source, inputs.range, mapper,
        [&](std::size_t done, std::size_t total, const FrameReport*) {
          progress.show(done, total);
          return !interrupted();
        },
        std::move(sequence), checkpoints.get(), finder.get());
  }
  MappingRun run =
      finished_run(std::move(inputs), std::move(header), std::move(mapper), std::move(sequence),
                   std::move(checkpoints), target, begun.tiles.get());
  run.frames_before = frames_before;
  return run;
}

namespace {

/// Lets the audience see the map, then stores it with the corrections that were made meanwhile.
/// Either may be null.
template <class Show, class Store>
LiveMapper::Watcher watcher(LiveAudience* audience, Checkpointer* checkpoints, Show show,
                            Store store) {
  return [=](Mapper& mapper, const auto& frames, const PinholeCamera& depth_camera) {
    if (audience) (audience->*show)(mapper, frames, depth_camera);
    if (audience && checkpoints) checkpoints->set_edits(audience->edits());
    if (checkpoints) (checkpoints->*store)(mapper, frames, depth_camera);
  };
}

}  // namespace

MappingRun map_live(const MappingOptions& options, double fps, const RunTarget& target,
                    LiveAudience* audience, FrameIntake* intake, CameraFeed* camera) {
  MappingInputs inputs(options, intake == nullptr);
  BegunRun begun = find_begun(target, inputs.config.memory);
  // The networks' threads inherit the priority of the one that opens them.
  std::async(std::launch::async, [&] {
    lower_thread_priority();
    inputs.open_networks(options);
  }).get();
  begin_in(begun, options, target, inputs);
  LiveMapper mapper(inputs.config.mapper, inputs.config.live, inputs.masks, inputs.encoder);
  mapper.recognize_with(inputs.recognizer);
  mapper.track_with(inputs.finder);
  MapHeader header = make_header(inputs, options, mapper.config());
  RepeatedRun repeated;
  if (!target.repeated.empty())
    repeated = find_repeated(target, header, inputs.tracking, inputs.encoder);
  const std::string pace = intake ? std::string("pushed") : concat(fps, " frames/s");
  header.config_text.insert(
      0, target.repeated.empty() ? concat("# live, ", pace, "\n") : repeated.title);
  watch_for_interrupt(kEndsOfALiveRun);
  if (audience)
    audience->begin(mapper.config(),
                    inputs.encoder ? inputs.encoder->identity() : EncoderIdentity{},
                    begun.document ? begun.document->names : std::map<InstanceId, std::string>{},
                    begun.document ? begun.document->edits : MapEdits{});
  const SequenceResult done = resume(begun, header, inputs, mapper, intake);
  auto checkpoints = make_checkpointer(begun, inputs, header, done.frames.size());
  mapper.after_frame =
      watcher(audience, checkpoints.get(), &LiveAudience::after_frame, &Checkpointer::after_frame);
  mapper.while_waiting = watcher(audience, checkpoints.get(), &LiveAudience::while_waiting,
                                 &Checkpointer::while_waiting);
  if (audience)
    mapper.after_tracking = [audience](const auto& frame) { audience->after_tracking(frame); };
  mapper.start();
  if (camera) camera->start();
  LiveRunResult live = target.repeated.empty()
                           ? feed(mapper, inputs, fps, intake)
                           : repeat_live(*inputs.source, repeated.steps, mapper, LiveProgressBar());
  if (audience) header.edits = audience->end();
  if (live.sequence.depth_camera.width == 0) live.sequence.depth_camera = done.depth_camera;
  MappingRun run = finished_run(std::move(inputs), std::move(header), mapper.take(), live.sequence,
                                std::move(checkpoints), target, begun.tiles.get());
  run.frames_before = done.frames.size();
  run.live = std::move(live);
  return run;
}

}  // namespace ovimap::apps
