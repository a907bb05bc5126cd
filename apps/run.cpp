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
  bool live = false;
  bool resume = false;
  double fps = 30;
};

void report_skipped(const SequenceResult& result) {
  std::vector<std::string> faults;
  for (const SkippedFrame& frame : result.skipped) faults.push_back(frame.fault);
  for (const FaultCount& fault : count_faults(faults))
    std::fprintf(stderr, "ovimap: skipped %lld frame(s), the first: %s\n",
                 static_cast<long long>(fault.frames), fault.example.c_str());
  if (interrupted()) std::fprintf(stderr, "ovimap: interrupted; saving what was mapped so far\n");
}

void report_bad_masks(const LiveStatistics& done) {
  if (done.masks_failed > 0)
    std::fprintf(stderr, "ovimap: the masks of %lld frame(s) are bad, the first: %s\n",
                 static_cast<long long>(done.masks_failed), done.mask_fault.c_str());
}

nlohmann::json lag_json(const StageSummary& lag) {
  return {{"p50_ms", lag.p50_ms}, {"p95_ms", lag.p95_ms}, {"p99_ms", lag.p99_ms}};
}

nlohmann::json live_json(const LiveRunResult& live, double fps) {
  const LiveStatistics& done = live.statistics;
  return {{"camera_fps", fps},
          {"frames_fused", done.frames_fused},
          {"frames_dropped", done.frames_dropped},
          {"frames_read_late", live.frames_read_late},
          {"camera_seconds", live.camera_seconds},
          {"mask_frames", done.mask_frames},
          {"masks_late", done.masks_late},
          {"masks_skipped", done.masks_skipped},
          {"masks_failed", done.masks_failed},
          {"views_skipped", done.views_skipped},
          {"geometry_lag", lag_json(done.geometry_lag)},
          {"mask_lag", lag_json(done.mask_lag)}};
}

void print_live(const LiveRunResult& live, double fps) {
  const LiveStatistics& done = live.statistics;
  std::printf(
      "camera at %.4g frames/s: %lld fused, %lld dropped; in the map after %.0f ms (p95 %.0f, "
      "p99 %.0f)\n",
      fps, static_cast<long long>(done.frames_fused), static_cast<long long>(done.frames_dropped),
      done.geometry_lag.p50_ms, done.geometry_lag.p95_ms, done.geometry_lag.p99_ms);
  if (live.frames_read_late > 0)
    std::printf("reading the recording was late for %lld frames\n",
                static_cast<long long>(live.frames_read_late));
  if (done.mask_frames + done.masks_skipped + done.masks_failed > 0)
    std::printf(
        "masks: %lld frames, in the map after %.1f s; %lld more wanted them while the "
        "network was busy\n",
        static_cast<long long>(done.mask_frames), done.mask_lag.p50_ms / 1e3,
        static_cast<long long>(done.masks_skipped));
  if (done.views_skipped > 0)
    std::printf("looks at objects left out: %lld\n", static_cast<long long>(done.views_skipped));
}

int run(const RunOptions& options) {
  const ThreadLimit limit(options.mapping.threads);
  check_map_target(options.map);
  if (!options.pictures.empty()) make_folder(options.pictures);
  const RunTarget target{options.map, options.resume};
  const MappingRun mapped = options.live ? map_live(options.mapping, options.fps, target)
                                         : map_recording(options.mapping, "mapping", {}, target);
  const SequenceResult& result = mapped.sequence;
  report_skipped(result);
  if (mapped.live) report_bad_masks(mapped.live->statistics);
  save_map(options.map, mapped.document);
  mapped.checkpoints->remove();
  if (!options.pictures.empty())
    write_map_pictures(options.pictures, mapped.document, *mapped.source);
  const double fps = static_cast<double>(result.frames.size()) / result.seconds;
  const TileTraffic tiles = tile_traffic(mapped.timers.summary());
  if (options.json) {
    nlohmann::json report = {{"map", options.map.string()},
                             {"frames", result.frames.size()},
                             {"frames_skipped", result.skipped.size()},
                             {"seconds", result.seconds},
                             {"fps", fps},
                             {"mask_frames", mapped.document.mask_frames},
                             {"interrupted", interrupted()},
                             {"stages", stages_json(mapped.timers)},
                             {"tiles_evicted", tiles.evicted},
                             {"tiles_loaded", tiles.loaded},
                             {"embedding_queries", embedding_queries(mapped.document.semantics)},
                             {"instances", mapped.document.instances.size()},
                             {"peak_rss_mb", peak_rss_mb()}};
    if (mapped.live) report["live"] = live_json(*mapped.live, options.fps);
    print_json(report);
  } else {
    std::printf("%s: %zu objects from %zu frames (%d with masks) in %.1f s (%.1f frames/s)\n",
                options.map.c_str(), mapped.document.instances.size(), result.frames.size(),
                mapped.document.mask_frames, result.seconds, fps);
    if (tiles.evicted > 0)
      std::printf("%zu tiles left memory on the way, %zu came back; peak memory %.0f MB\n",
                  tiles.evicted, tiles.loaded, peak_rss_mb());
    if (mapped.live) print_live(*mapped.live, options.fps);
  }
  if (mapped.document.instances.empty())
    std::fprintf(
        stderr,
        "ovimap: no object was seen often enough to be kept; map more frames, or --set %s=1 "
        "where masks are slow\n",
        mapped.live ? "live.masks.min_gap" : "mask_interval");
  return kDone;
}

}  // namespace

Action add_run(CLI::App& command) {
  auto options = std::make_shared<RunOptions>();
  add_mapping_options(command, options->mapping);
  command.add_option("-o,--output", options->map, "map file to write")->required();
  command.add_option("--pictures", options->pictures, "folder for a top view and a contact sheet");
  auto* live = command.add_flag("--live", options->live,
                                "take frames at a camera's pace and leave out what comes too late");
  command.add_option("--fps", options->fps, "that pace, frames a second")
      ->check(CLI::Range(0.1, 1000.))
      ->needs(live)
      ->capture_default_str();
  add_max_memory(command, options->mapping);
  command.add_flag("--resume", options->resume,
                   "go on with the frames that a killed run, or the map, does not have yet");
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return run(*options); };
}

}  // namespace ovimap::apps
