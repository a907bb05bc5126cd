// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "mapping_run.h"

#include <algorithm>
#include <future>
#include <sstream>

#include "ovimap/base/thread_priority.h"
#include "ovimap/inference/id_mask_sources.h"
#include "ovimap/io/map_file.h"

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

/// What the options ask for, opened.
struct MappingInputs {
  explicit MappingInputs(const MappingOptions& options) : config(read_program_config(options)) {
    config.masks.runtime.threads = network_threads(config, options);
    source = open_frame_source(options.source, config.source);
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
  std::unique_ptr<FrameSource> source;
  std::vector<std::int64_t> range;
  std::shared_ptr<MaskSource> masks;
  std::shared_ptr<ImageTextEncoder> encoder;
};

/// What a run goes on with, and where its checkpoints go.
struct BegunRun {
  std::optional<MapDocument> document;
  CheckpointFile::Start start = CheckpointFile::Start::kAnew;
  std::map<InstanceId, std::string> names;  ///< what people gave the map: no run makes that anew
  MapEdits edits;
};

BegunRun begun_run(MapDocument&& document, CheckpointFile::Start start) {
  auto names = document.names;
  auto edits = document.edits;
  return {std::move(document), start, std::move(names), std::move(edits)};
}

BegunRun find_begun(const RunTarget& target) {
  const std::filesystem::path partial = checkpoint_path(target.map);
  if (target.map.empty()) return {};
  if (holds_checkpoint(partial)) {
    if (!target.resume)
      throw Error(concat("an unfinished run left '", partial.string(), "' with ",
                         read_map_info(partial).frames,
                         " frames; --resume goes on with it, or delete it to begin anew"));
    return begun_run(load_map(partial), CheckpointFile::Start::kGoOn);
  }
  if (target.resume && std::filesystem::exists(target.map))
    return begun_run(load_map(target.map), CheckpointFile::Start::kAnew);
  return {};
}

/// The lines of a configuration that decide what the map becomes: which frames it is made from, and
/// when it is stored, may differ.
std::vector<std::string> deciding_lines(const std::string& config) {
  std::vector<std::string> lines;
  std::istringstream stream(config);
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("# preset")) line.resize(std::min(line.size(), line.find(", frames ")));
    if (!line.starts_with("checkpoint.") && !line.starts_with("# live")) lines.push_back(line);
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

/// Gives `mapper`, a Mapper or a LiveMapper, what an earlier run had; returns its frames.
template <class AnyMapper>
SequenceResult resume(BegunRun& begun, const std::string& config, MappingInputs& inputs,
                      AnyMapper& mapper) {
  SequenceResult sequence;
  if (!begun.document) return sequence;
  require_same_settings(begun.document->config_text, config);
  sequence.frames = begun.document->frames;
  sequence.depth_camera = begun.document->depth_camera;
  skip_done(inputs.range, sequence.frames);
  mapper.restore(std::move(*begun.document));
  return sequence;
}

std::unique_ptr<Checkpointer> make_checkpointer(const RunTarget& target, const BegunRun& begun,
                                                const MappingInputs& inputs,
                                                const std::string& source,
                                                const std::string& config,
                                                std::size_t frames_done) {
  if (target.map.empty()) return nullptr;
  return std::make_unique<Checkpointer>(
      checkpoint_path(target.map), inputs.config.checkpoint,
      Checkpointer::Header{source, config, frames_done, begun.names, begun.edits}, begun.start);
}

std::string source_text(const MappingInputs& inputs, const MappingOptions& options) {
  return inputs.source->kind() + ":" + options.source;
}

MappingRun finished_run(MappingInputs&& inputs, const MappingOptions& options, BegunRun&& begun,
                        Mapper&& mapper, SequenceResult sequence) {
  MappingRun run;
  const std::string source = source_text(inputs, options);
  run.source = std::move(inputs.source);
  run.sequence = std::move(sequence);
  const std::string config_text =
      effective_config(inputs.config, options, mapper.config(), mapper.encoder());
  mapper.finish();
  run.timers = mapper.timers();
  run.document = make_document(std::move(mapper), run.sequence, source, config_text);
  run.document.names = std::move(begun.names);
  run.document.edits = std::move(begun.edits);
  return run;
}

}  // namespace

MappingRun map_recording(const MappingOptions& options, const std::string& title,
                         const std::filesystem::path& keep_masks, const RunTarget& target) {
  BegunRun begun = find_begun(target);
  MappingInputs inputs(options);
  inputs.open_networks(options, keep_masks);
  Mapper mapper(inputs.config.mapper, inputs.masks, inputs.encoder);
  const std::string config =
      effective_config(inputs.config, options, mapper.config(), inputs.encoder);
  SequenceResult sequence = resume(begun, config, inputs, mapper);
  auto checkpoints = make_checkpointer(target, begun, inputs, source_text(inputs, options), config,
                                       sequence.frames.size());
  watch_for_interrupt();
  {
    Progress progress(title);
    sequence = run_sequence(
        *inputs.source, inputs.range, mapper,
        [&](std::size_t done, std::size_t total, const FrameReport*) {
          progress.show(done, total);
          return !interrupted();
        },
        std::move(sequence), checkpoints.get());
  }
  MappingRun run = finished_run(std::move(inputs), options, std::move(begun), std::move(mapper),
                                std::move(sequence));
  run.checkpoints = std::move(checkpoints);
  return run;
}

MappingRun map_live(const MappingOptions& options, double fps, const RunTarget& target) {
  BegunRun begun = find_begun(target);
  MappingInputs inputs(options);
  // The networks' threads inherit the priority of the one that opens them.
  std::async(std::launch::async, [&] {
    lower_thread_priority();
    inputs.open_networks(options);
  }).get();
  LiveMapper mapper(inputs.config.mapper, inputs.config.live, inputs.masks, inputs.encoder);
  const std::string config =
      concat("# live, ", fps, " frames/s\n",
             effective_config(inputs.config, options, mapper.config(), inputs.encoder));
  const SequenceResult done = resume(begun, config, inputs, mapper);
  auto checkpoints = make_checkpointer(target, begun, inputs, source_text(inputs, options), config,
                                       done.frames.size());
  if (checkpoints)
    mapper.after_frame = [&](Mapper& map, const auto& frames, const PinholeCamera& camera) {
      checkpoints->after_frame(map, frames, camera);
    };
  watch_for_interrupt();
  LiveRunResult live;
  {
    Progress progress("mapping live");
    live = run_live(*inputs.source, inputs.range, mapper, fps,
                    [&](std::size_t count, std::size_t total) {
                      progress.show(count, total);
                      return !interrupted();
                    });
  }
  if (inputs.range.empty()) live.sequence.depth_camera = done.depth_camera;
  MappingRun run =
      finished_run(std::move(inputs), options, std::move(begun), mapper.take(), live.sequence);
  run.document.config_text = config;
  run.checkpoints = std::move(checkpoints);
  run.live = std::move(live);
  return run;
}

}  // namespace ovimap::apps
