// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "mapping_run.h"

#include <future>

#include "ovimap/base/thread_priority.h"
#include "ovimap/inference/id_mask_sources.h"

namespace ovimap::apps {

namespace {

/// The settings that made the map, with what the command line chose beside them.
std::string effective_config(ProgramConfig config, const MappingOptions& options,
                             const Mapper& mapper) {
  config.mapper = mapper.config();
  ConfigFields fields;
  list_fields(config, fields);
  return concat("# preset ", options.preset, ", masks ", options.masks, ", encoder ",
                mapper.encoder() ? mapper.encoder()->identity().name : "none", ", frames ",
                options.frames, "\n", fields.dump());
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

MappingRun finished_run(MappingInputs&& inputs, const MappingOptions& options, Mapper&& mapper,
                        SequenceResult sequence) {
  MappingRun run;
  run.source = std::move(inputs.source);
  run.sequence = std::move(sequence);
  const std::string config_text = effective_config(inputs.config, options, mapper);
  mapper.finish();
  run.timers = mapper.timers();
  run.document = make_document(std::move(mapper), run.sequence,
                               run.source->kind() + ":" + options.source, config_text);
  return run;
}

}  // namespace

MappingRun map_recording(const MappingOptions& options, const std::string& title,
                         const std::filesystem::path& keep_masks) {
  MappingInputs inputs(options);
  inputs.open_networks(options, keep_masks);
  Mapper mapper(inputs.config.mapper, inputs.masks, inputs.encoder);
  watch_for_interrupt();
  SequenceResult sequence;
  {
    Progress progress(title);
    sequence = run_sequence(*inputs.source, inputs.range, mapper,
                            [&](std::size_t done, std::size_t total, const FrameReport*) {
                              progress.show(done, total);
                              return !interrupted();
                            });
  }
  return finished_run(std::move(inputs), options, std::move(mapper), std::move(sequence));
}

MappingRun map_live(const MappingOptions& options, double fps) {
  MappingInputs inputs(options);
  // The networks' threads inherit the priority of the one that opens them.
  std::async(std::launch::async, [&] {
    lower_thread_priority();
    inputs.open_networks(options);
  }).get();
  LiveMapper mapper(inputs.config.mapper, inputs.config.live, inputs.masks, inputs.encoder);
  watch_for_interrupt();
  LiveRunResult live;
  {
    Progress progress("mapping live");
    live = run_live(*inputs.source, inputs.range, mapper, fps,
                    [&](std::size_t done, std::size_t total) {
                      progress.show(done, total);
                      return !interrupted();
                    });
  }
  MappingRun run = finished_run(std::move(inputs), options, mapper.take(), live.sequence);
  run.document.config_text = concat("# live, ", fps, " frames/s\n", run.document.config_text);
  run.live = std::move(live);
  return run;
}

}  // namespace ovimap::apps
