// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "mapping_run.h"

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

}  // namespace

MappingRun map_recording(const MappingOptions& options, const std::string& title,
                         const std::filesystem::path& keep_masks) {
  ProgramConfig config = read_program_config(options);
  config.masks.runtime.threads = network_threads(config, options);
  MappingRun run;
  run.source = open_frame_source(options.source, config.source);
  const auto range = positions(parse_frame_range(options.frames), run.source->size());
  auto masks =
      make_mask_source(options.masks, config.masks, {run.source.get(), options.model_dirs});
  if (masks && !keep_masks.empty())
    masks = std::make_unique<KeptMaskSource>(keep_masks, std::move(masks));
  Mapper mapper(config.mapper, std::move(masks), make_encoder(options, config));
  watch_for_interrupt();
  {
    Progress progress(title);
    run.sequence = run_sequence(*run.source, range, mapper,
                                [&](std::size_t done, std::size_t total, const FrameReport*) {
                                  progress.show(done, total);
                                  return !interrupted();
                                });
  }
  const std::string config_text = effective_config(config, options, mapper);
  mapper.finish();
  run.timers = mapper.timers();
  run.document = make_document(std::move(mapper), run.sequence,
                               run.source->kind() + ":" + options.source, config_text);
  return run;
}

}  // namespace ovimap::apps
