// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "mapping_run.h"
#include "ovimap/base/parallel.h"
#include "ovimap/io/map_file.h"
#include "ovimap/pipeline/map_pictures.h"

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

int run(const RunOptions& options) {
  const ThreadLimit limit(options.mapping.threads);
  check_map_target(options.map);
  if (!options.pictures.empty()) make_folder(options.pictures);
  const MappingRun mapped = map_recording(options.mapping, "mapping");
  const SequenceResult& result = mapped.sequence;
  report_skipped(result);
  save_map(options.map, mapped.document);
  if (!options.pictures.empty())
    write_map_pictures(options.pictures, mapped.document, *mapped.source);
  const double fps = static_cast<double>(result.frames.size()) / result.seconds;
  if (options.json)
    print_json({{"map", options.map.string()},
                {"frames", result.frames.size()},
                {"frames_skipped", result.skipped.size()},
                {"seconds", result.seconds},
                {"fps", fps},
                {"mask_frames", mapped.document.mask_frames},
                {"interrupted", interrupted()},
                {"stages", stages_json(mapped.timers)},
                {"embedding_queries", embedding_queries(mapped.document.semantics)},
                {"instances", mapped.document.instances.size()},
                {"peak_rss_mb", peak_rss_mb()}});
  else
    std::printf("%s: %zu objects from %zu frames (%d with masks) in %.1f s (%.1f frames/s)\n",
                options.map.c_str(), mapped.document.instances.size(), result.frames.size(),
                mapped.document.mask_frames, result.seconds, fps);
  if (mapped.document.instances.empty())
    std::fprintf(stderr,
                 "ovimap: no object was seen often enough to be kept; map more frames, or --set "
                 "mask_interval=1 where masks are slow\n");
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
