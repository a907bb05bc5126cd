// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "command.h"
#include "ovimap/base/parallel.h"
#include "ovimap/io/map_file.h"
#include "ovimap/pipeline/map_pictures.h"
#include "ovimap/pipeline/sequence_run.h"

namespace ovimap::apps {

namespace {

struct RunOptions {
  MappingOptions mapping;
  std::filesystem::path map;
  std::filesystem::path pictures;
  bool json = false;
};

void report_skipped(const SequenceResult& result) {
  std::vector<std::string> faults;
  for (const SkippedFrame& frame : result.skipped) faults.push_back(frame.fault);
  for (const FaultCount& fault : count_faults(faults))
    std::fprintf(stderr, "ovimap: skipped %lld frame(s), the first: %s\n",
                 static_cast<long long>(fault.frames), fault.example.c_str());
  if (interrupted()) std::fprintf(stderr, "ovimap: interrupted; saving what was mapped so far\n");
}

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

int run(const RunOptions& options) {
  const ThreadLimit limit(options.mapping.threads);
  ProgramConfig config = read_program_config(options.mapping);
  config.masks.runtime.threads = network_threads(config, options.mapping);
  check_map_target(options.map);
  if (!options.pictures.empty()) make_folder(options.pictures);
  const auto source = open_frame_source(options.mapping.source, config.source);
  const auto range = positions(parse_frame_range(options.mapping.frames), source->size());
  auto masks = make_mask_source(options.mapping.masks, config.masks,
                                {source.get(), options.mapping.model_dirs});

  Mapper mapper(config.mapper, std::move(masks), make_encoder(options.mapping, config));
  watch_for_interrupt();
  SequenceResult result;
  {
    Progress progress("mapping");
    result = run_sequence(*source, range, mapper,
                          [&](std::size_t done, std::size_t total, const FrameReport*) {
                            progress.show(done, total);
                            return !interrupted();
                          });
  }
  report_skipped(result);
  nlohmann::json summary = {{"map", options.map.string()},
                            {"frames", result.frames.size()},
                            {"frames_skipped", result.skipped.size()},
                            {"seconds", result.seconds},
                            {"fps", static_cast<double>(result.frames.size()) / result.seconds},
                            {"mask_frames", mapper.mask_frames()},
                            {"interrupted", interrupted()}};
  const std::string config_text = effective_config(config, options.mapping, mapper);
  mapper.finish();
  summary["stages"] = stages_json(mapper.timers());
  const MapDocument document = make_document(
      std::move(mapper), result, source->kind() + ":" + options.mapping.source, config_text);
  save_map(options.map, document);
  if (!options.pictures.empty()) write_map_pictures(options.pictures, document, *source);
  summary["embedding_queries"] = embedding_queries(document.semantics);
  summary["instances"] = document.instances.size();
  summary["peak_rss_mb"] = peak_rss_mb();
  if (options.json)
    print_json(summary);
  else
    std::printf("%s: %zu objects from %zu frames in %.1f s (%.1f frames/s)\n", options.map.c_str(),
                document.instances.size(), result.frames.size(), result.seconds,
                summary["fps"].get<double>());
  return kDone;
}

}  // namespace

Action add_run(CLI::App& command) {
  auto options = std::make_shared<RunOptions>();
  add_mapping_options(command, options->mapping);
  command.add_option("-o,--output", options->map, "map file to write")->required();
  command.add_option("--pictures", options->pictures, "folder for a top view and a contact sheet");
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return run(*options); };
}

}  // namespace ovimap::apps
