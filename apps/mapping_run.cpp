// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "mapping_run.h"

#include <algorithm>
#include <future>
#include <sstream>

#include "ovimap/base/thread_priority.h"
#include "ovimap/inference/masks/id_mask_sources.h"
#include "ovimap/io/map_file/map_file.h"

namespace ovimap::apps {

namespace {

constexpr int kStoreForLoops_mb = 1000;  // a closed loop fuses the frames again

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

/// What the options ask for, opened.
struct MappingInputs {
  explicit MappingInputs(const MappingOptions& options, bool recorded = true)
      : config(read_program_config(options)) {
    config.masks.runtime.threads = network_threads(config, options);
    if (recorded) {
      config.source.poses = options.poses == "auto"    ? PoseNeed::kAllOrNone
                            : options.poses == "track" ? PoseNeed::kNone
                                                       : PoseNeed::kAll;
      source = open_frame_source(options.source, config.source);
    }
    tracking = options.poses == "track" || options.poses == "refine" ||
               (source && !source->posed());
    keeps_for_loops = tracking && config.mapper.frame_store.max_mb == 0;
    if (keeps_for_loops) config.mapper.frame_store.max_mb = kStoreForLoops_mb;
    if (!recorded) return;
    range = positions(parse_frame_range(options.frames), source->size());
  }
  void open_networks(const MappingOptions& options, const std::filesystem::path& keep_masks = {}) {
    auto found = make_mask_source(options.masks, config.masks, {source.get(), options.model_dirs});
    if (found && !keep_masks.empty())
      found = std::make_unique<KeptMaskSource>(keep_masks, std::move(found));
    masks = std::move(found);
    encoder = make_encoder(options, config);
  }

  ProgramConfig config;
  std::unique_ptr<FrameSource> source;  ///< null where frames are pushed
  bool tracking = false;                ///< poses are to be found
  bool keeps_for_loops = false;         ///< frames are kept for that alone
  std::vector<std::int64_t> range;
  std::shared_ptr<MaskSource> masks;
  std::shared_ptr<ImageTextEncoder> encoder;
};

/// What a run goes on with, and where its checkpoints go.
struct BegunRun {
  std::optional<MapDocument> document;
  std::shared_ptr<TileKeeper> tiles;  ///< null: nowhere
};

/// With a bound on memory the voxels stay in the checkpoint's file, where tiles go as well.
void load_begun(const std::filesystem::path& map, BegunRun& begun) {
  if (!begun.tiles->bounded()) {
    begun.document = load_map(map);
  } else {
    begun.document = load_map_without_voxels(map);
    if (map != begun.tiles->path()) begun.tiles->adopt(map);
    begun.document->map.keep_in(begun.tiles);
  }
}

BegunRun find_begun(const RunTarget& target, const MemoryConfig& memory) {
  BegunRun begun;
  if (target.map.empty()) {
    if (memory.max_mb > 0)
      throw Error("memory.max_mb is for `run` and `bench`; leave it away or set it to 0");
    return begun;
  }
  const std::filesystem::path partial = checkpoint_path(target.map);
  const bool unfinished = holds_checkpoint(partial);
  if (unfinished && !target.resume)
    throw Error(concat("an unfinished run left '", partial.string(), "' with ",
                       read_map_info(partial).frames,
                       " frames; --resume goes on with it, or delete it to begin anew"));
  begun.tiles = std::make_shared<TileKeeper>(
      partial, unfinished ? TileKeeper::Start::kGoOn : TileKeeper::Start::kAnew, memory);
  if (unfinished)
    load_begun(partial, begun);
  else if (target.resume && std::filesystem::exists(target.map))
    load_begun(target.map, begun);
  return begun;
}

/// The lines of a configuration that decide what the map becomes: which frames it is made from, and
/// when and where it is kept, may differ.
std::vector<std::string> deciding_lines(const std::string& config) {
  std::vector<std::string> lines;
  std::istringstream stream(config);
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("# preset")) line.resize(std::min(line.size(), line.find(", frames ")));
    const auto names = [&](const char* start) { return line.starts_with(start); };
    if (!names("checkpoint.") && !names("memory.") && !names("# live")) lines.push_back(line);
  }
  return lines;
}

/// Throws Error naming the first setting in which two runs differ.
void require_same_settings(const std::string& begun, const std::string& now) {
  const std::vector<std::string> before = deciding_lines(begun), after = deciding_lines(now);
  const auto [old_line, new_line] =
      std::mismatch(before.begin(), before.end(), after.begin(), after.end());
  if (old_line == before.end() && new_line == after.end()) return;
  throw Error(concat("the run to resume had '", old_line == before.end() ? "" : *old_line,
                     "', this one has '", new_line == after.end() ? "" : *new_line,
                     "'; give the same options, or map anew without --resume"));
}

/// Frames that are not in the map yet.
void skip_done(std::vector<std::int64_t>& range, const std::vector<FrameLogEntry>& done) {
  if (!done.empty())
    std::erase_if(range, [&](std::int64_t position) { return position <= done.back().index; });
}

/// Gives `mapper`, a Mapper or a LiveMapper, what an earlier run had, and `header` what people told
/// that run's map, which no run finds anew; returns its frames.
template <class AnyMapper>
SequenceResult resume(BegunRun& begun, MapHeader& header, MappingInputs& inputs,
                      AnyMapper& mapper) {
  SequenceResult sequence;
  if (!begun.document) return sequence;
  require_same_settings(begun.document->config_text, header.config_text);
  header.names = begun.document->names;
  header.edits = begun.document->edits;
  sequence.frames = begun.document->frames;
  sequence.depth_camera = begun.document->depth_camera;
  skip_done(inputs.range, sequence.frames);
  mapper.restore(std::move(*begun.document));
  return sequence;
}

std::unique_ptr<Checkpointer> make_checkpointer(const BegunRun& begun, const MappingInputs& inputs,
                                                const MapHeader& header, std::size_t frames_done) {
  if (!begun.tiles) return nullptr;
  return std::make_unique<Checkpointer>(begun.tiles, inputs.config.checkpoint, header, frames_done);
}

MapHeader make_header(const MappingInputs& inputs, const MappingOptions& options,
                      const MapperConfig& mapper) {
  return {inputs.source ? inputs.source->kind() + ":" + options.source : options.source,
          effective_config(inputs.config, options, mapper, inputs.encoder)};
}

/// The tracker of a run whose poses are to be found, at home in what the run goes on with.
std::optional<Tracker> make_tracker(const MappingInputs& inputs, const BegunRun& begun) {
  if (!inputs.tracking) return std::nullopt;
  Tracker tracker(inputs.config.track);
  if (begun.document && !begun.document->frames.empty()) {
    if (begun.document->kept_frames.empty())
      throw Error("the map to go on with keeps no frames to find the camera's place by; map it with "
                  "--set frame_store.max_mb=1000");
    tracker.begin_in(keyframes_of(*begun.document, inputs.config.track.keyframes));
  }
  return tracker;
}

/// What tracking did, and, where the camera came by a place again, the map with its loops closed.
/// Frames that were kept for that alone are not saved.
TrackingRun finish_tracking(const Tracker& tracker, const ProgramConfig& config, bool keep_frames,
                            MapDocument& map) {
  TrackingRun tracking{summarise(tracker.log()), {}};
  if (!map.kept_frames.empty()) {
    Progress progress("closing loops");
    tracking.loops = close_map_loops(
        map, config.mapper, config.track, config.loops,
        [&](std::size_t done, std::size_t total) { progress.show(done, total); });
  }
  if (!keep_frames) map.kept_frames.clear();
  return tracking;
}

MappingRun finished_run(MappingInputs&& inputs, MapHeader header, Mapper&& mapper,
                        SequenceResult sequence, std::unique_ptr<Checkpointer> checkpoints) {
  MappingRun run;
  run.source = std::move(inputs.source);
  run.masks_wanted = inputs.masks != nullptr;
  run.sequence = std::move(sequence);
  mapper.finish();
  if (checkpoints) {
    checkpoints->end_frames(mapper);
    checkpoints->report(mapper.timers());
  }
  run.timers = mapper.timers();
  run.document = make_document(std::move(mapper), run.sequence, std::move(header));
  run.checkpoints = std::move(checkpoints);
  return run;
}

}  // namespace

MappingRun map_recording(const MappingOptions& options, const std::string& title,
                         const std::filesystem::path& keep_masks, const RunTarget& target) {
  MappingInputs inputs(options);
  BegunRun begun = find_begun(target, inputs.config.memory);
  inputs.open_networks(options, keep_masks);
  std::optional<Tracker> tracker = make_tracker(inputs, begun);
  Mapper mapper(inputs.config.mapper, inputs.masks, inputs.encoder);
  MapHeader header = make_header(inputs, options, mapper.config());
  SequenceResult sequence = resume(begun, header, inputs, mapper);
  auto checkpoints = make_checkpointer(begun, inputs, header, sequence.frames.size());
  watch_for_interrupt();
  {
    Progress progress(title);
    sequence = run_sequence(
        *inputs.source, inputs.range, mapper,
        [&](std::size_t done, std::size_t total, const FrameReport*) {
          progress.show(done, total);
          return !interrupted();
        },
        std::move(sequence), checkpoints.get(), tracker ? &*tracker : nullptr);
  }
  const ProgramConfig config = inputs.config;
  const bool keep_frames = !inputs.keeps_for_loops;
  MappingRun run = finished_run(std::move(inputs), std::move(header), std::move(mapper),
                                std::move(sequence), std::move(checkpoints));
  if (tracker) run.tracking = finish_tracking(*tracker, config, keep_frames, run.document);
  return run;
}

MappingRun map_live(const MappingOptions& options, double fps, const RunTarget& target,
                    LiveAudience* audience, FrameIntake* intake) {
  MappingInputs inputs(options, intake == nullptr);
  BegunRun begun = find_begun(target, inputs.config.memory);
  // The networks' threads inherit the priority of the one that opens them.
  std::async(std::launch::async, [&] {
    lower_thread_priority();
    inputs.open_networks(options);
  }).get();
  LiveMapper mapper(inputs.config.mapper, inputs.config.live, inputs.masks, inputs.encoder);
  std::shared_ptr<Tracker> tracker;
  if (auto made = make_tracker(inputs, begun))
    tracker = std::make_shared<Tracker>(std::move(*made));
  mapper.track_with(tracker);
  MapHeader header = make_header(inputs, options, mapper.config());
  const std::string pace = intake ? std::string("pushed") : concat(fps, " frames/s");
  header.config_text.insert(0, concat("# live, ", pace, "\n"));
  const SequenceResult done = resume(begun, header, inputs, mapper);
  if (intake && !done.frames.empty())
    intake->resume_at(done.frames.back().index + 1, done.depth_camera);
  auto checkpoints = make_checkpointer(begun, inputs, header, done.frames.size());
  mapper.after_frame = [&](Mapper& map, const auto& frames, const PinholeCamera& camera) {
    if (audience) audience->after_frame(map, frames, camera);
    if (audience && checkpoints) checkpoints->set_edits(audience->edits());
    if (checkpoints) checkpoints->after_frame(map, frames, camera);
  };
  if (audience)
    audience->begin(mapper.config(),
                    inputs.encoder ? inputs.encoder->identity() : EncoderIdentity{}, header.names,
                    header.edits);
  watch_for_interrupt();
  LiveRunResult live;
  {
    Progress progress("mapping live");
    const LiveProgress look = [&](std::size_t count, std::size_t total) {
      progress.show(count, total);
      return !interrupted();
    };
    live = intake ? run_pushed(*intake, mapper, look)
                  : run_live(*inputs.source, inputs.range, mapper, fps, look);
  }
  if (audience) header.edits = audience->end();
  if (live.sequence.depth_camera.width == 0) live.sequence.depth_camera = done.depth_camera;
  const ProgramConfig config = inputs.config;
  const bool keep_frames = !inputs.keeps_for_loops;
  MappingRun run = finished_run(std::move(inputs), std::move(header), mapper.take(), live.sequence,
                                std::move(checkpoints));
  if (tracker) run.tracking = finish_tracking(*tracker, config, keep_frames, run.document);
  run.live = std::move(live);
  return run;
}

}  // namespace ovimap::apps
