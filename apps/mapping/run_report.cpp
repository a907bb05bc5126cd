// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "run_report.h"

#include <cstdio>
#include <numbers>

#include "ovimap/base/listed.h"
#include "ovimap/hub/catalogue/catalogue.h"
#include "ovimap/inference/models/model_folder.h"

namespace ovimap::apps {

namespace {

void report_skipped(const SequenceResult& result) {
  std::vector<std::string> faults;
  for (const SkippedFrame& frame : result.skipped) faults.push_back(frame.fault);
  for (const FaultCount& fault : count_faults(faults))
    warn(concat("skipped ", fault.frames, " frame(s), the first: ", fault.example));
  if (interrupted()) warn("interrupted; saving what was mapped so far");
}

void report_bad_frames(const LiveStatistics& done) {
  if (done.frames_failed > 0)
    warn(concat(done.frames_failed, " frame(s) were left out, the first: ", done.frame_fault));
}

void report_bad_masks(const LiveStatistics& done) {
  if (done.masks_failed > 0)
    warn(concat("the masks of ", done.masks_failed,
                " frame(s) are bad, the first: ", done.mask_fault));
}

void report_encoder(const LiveStatistics& done) {
  if (done.views_failed > 0)
    warn(concat("the encoder failed on ", done.views_failed, " view(s), the first: ",
                done.encoder_fault, "; `ovimap reembed` gives their objects embeddings"));
}

nlohmann::json movers_json(const MapRecord& map) {
  nlohmann::json movers = nlohmann::json::array();
  for (const Mover& mover : map.movers) {
    double way_m = 0;
    for (std::size_t i = 1; i < mover.path.size(); ++i)
      way_m += static_cast<double>((mover.path[i].place - mover.path[i - 1].place).norm());
    movers.push_back({{"id", mover.id},
                      {"frames", mover.path.size()},
                      {"first_frame", mover.path.front().frame},
                      {"last_frame", mover.path.back().frame},
                      {"way_m", way_m}});
  }
  return movers;
}

nlohmann::json lag_json(const StageSummary& lag) {
  return {{"p50_ms", lag.p50_ms}, {"p95_ms", lag.p95_ms}, {"p99_ms", lag.p99_ms}};
}

nlohmann::json live_json(const LiveRunResult& live, double fps) {
  const LiveStatistics& done = live.statistics;
  return {{"camera_fps", fps},
          {"frames_fused", done.frames_fused},
          {"frames_dropped", done.frames_dropped},
          {"frames_lost", done.frames_lost},
          {"frames_failed", done.frames_failed},
          {"pose_updates", done.pose_updates},
          {"frames_read_late", live.frames_read_late},
          {"camera_seconds", live.camera_seconds},
          {"mask_frames", done.mask_frames},
          {"masks_late", done.masks_late},
          {"masks_skipped", done.masks_skipped},
          {"masks_failed", done.masks_failed},
          {"masks_absent", done.masks_absent},
          {"views_skipped", done.views_skipped},
          {"views_failed", done.views_failed},
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
        "masks: %lld frames, in the map after %.1f s; %lld more wanted them than could wait\n",
        static_cast<long long>(done.mask_frames), done.mask_lag.p50_ms / 1e3,
        static_cast<long long>(done.masks_skipped));
  if (done.views_skipped > 0)
    std::printf("looks at objects left out: %lld\n", static_cast<long long>(done.views_skipped));
}

void print_repetition(const Repetition& repetition) {
  if (repetition.differing.empty()) {
    std::printf("the same map as %s, bit for bit\n", repetition.of.c_str());
    return;
  }
  std::printf("another map than %s; they differ in: %s\n", repetition.of.c_str(),
              listed(repetition.differing).c_str());
}

nlohmann::json placing_json(const std::optional<AlignmentSearch>& placing) {
  if (!placing) return nullptr;
  return {{"doubt", placing->doubt},
          {"objects", placing->best.objects},
          {"overlap", placing->best.overlap},
          {"fit", placing->best.fit}};
}

nlohmann::json tracking_json(const TrackingRun& tracking) {
  const TrackSummary& done = tracking.summary;
  nlohmann::json lost = nlohmann::json::array();
  for (const auto& [first, last] : done.lost) lost.push_back({first, last});
  return {{"frames", done.frames},
          {"doubts", tracking.sensor_doubts},
          {"by_objects", placing_json(tracking.placing)},
          {"frames_tracked", done.tracked},
          {"lost", lost},
          {"found_times", done.found_times},
          {"frames_degenerate", done.degenerate},
          {"loop_corrections", tracking.corrections.times},
          {"loop_corrected_m", tracking.corrections.furthest_m},
          {"loop_candidates", tracking.loops.candidates},
          {"loops_closed", tracking.loops.closed},
          {"loops_dropped", tracking.loops.dropped},
          {"loop_moved_m", tracking.loops.furthest_m},
          {"loop_fused_share", tracking.loops.fused_share}};
}

/// Row by row; null where the recording stayed where it was.
nlohmann::json move_json(const std::optional<Pose>& move) {
  if (!move) return nullptr;
  nlohmann::json rows = nlohmann::json::array();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) rows.push_back(move->matrix()(row, column));
  return rows;
}

void print_move(const Pose& move) {
  std::printf("the recording was turned by %.1f degrees and moved by %.2f m to where the map is\n",
              Eigen::AngleAxisd(move.linear()).angle() * 180 / std::numbers::pi,
              move.translation().norm());
}

nlohmann::json parts_json(const std::vector<MapPart>& parts) {
  nlohmann::json list = nlohmann::json::array();
  for (const MapPart& part : parts)
    list.push_back({{"map", part.map.string()},
                    {"first", part.first},
                    {"last", part.last},
                    {"frames", part.frames},
                    {"instances", part.objects},
                    {"by_objects", placing_json(part.placing)}});
  return list;
}

void print_parts(const MappingRun& run) {
  for (const MapPart& part : run.parts) {
    const bool placed = part.placing && part.placing->doubt.empty();
    std::printf(
        "no keyframe shows where frames %lld to %lld lie: %s is a map of them alone, %zu "
        "objects from %zu frames; %s\n",
        static_cast<long long>(part.first), static_cast<long long>(part.last), part.map.c_str(),
        part.objects, part.frames,
        placed ? "by its objects it lies in this map, `ovimap merge --align` joins the two"
               : "`ovimap merge --align` joins maps that share a place");
  }
}

void print_tracking(const TrackingRun& tracking) {
  if (tracking.placing && tracking.placing->doubt.empty())
    std::printf(
        "no first frame shows a known place; %d objects say where the recording lies, and the "
        "surfaces agree (overlap %.0f %%, fit %.0f %%)\n",
        tracking.placing->best.objects, 100. * double{tracking.placing->best.overlap},
        100. * double{tracking.placing->best.fit});
  std::printf("%s\n", summary_line(tracking.summary).c_str());
  if (tracking.summary.degenerate > 0)
    std::printf("in %zu frames the images did not tell every direction of the motion\n",
                tracking.summary.degenerate);
  if (const LoopCorrections& corrected = tracking.corrections; corrected.times > 0)
    std::printf(
        "places were seen again while frames came: the map was corrected %zu %s, and poses "
        "moved by up to %.1f cm\n",
        corrected.times, corrected.times == 1 ? "time" : "times", 100 * corrected.furthest_m);
  if (tracking.loops.closed > 0)
    std::printf(
        "%zu places were seen again; poses moved by up to %.1f cm, and %.0f %% of the map "
        "was fused anew\n",
        tracking.loops.closed, 100 * tracking.loops.furthest_m, 100 * tracking.loops.fused_share);
}

/// What a further visit to a place found.
void print_changes(const std::filesystem::path& map, const MapHistory& history) {
  if (history.visits.size() < 2) return;
  std::map<ObjectEventKind, int> counts;
  for (const ObjectEvent& event : history.events)
    if (event.visit == static_cast<int>(history.visits.size())) ++counts[event.kind];
  std::printf("visit %zu: %d moved, %d gone, %d new; `ovimap info %s --history` tells which\n",
              history.visits.size(), counts[ObjectEventKind::kMoved],
              counts[ObjectEventKind::kGone], counts[ObjectEventKind::kAppeared], map.c_str());
}

bool masks_all_absent(const MappingRun& run) {
  return run.masks_wanted && run.document.mask_frames == 0;
}

bool mostly_blank(const MappingRun& run) {
  return 2 * run.masks_seen.blank > run.masks_seen.frames;
}

double frames_per_second(const MappingRun& run) {
  const std::size_t fused = run.sequence.frames.size() - run.frames_before;
  return fused == 0 ? 0 : static_cast<double>(fused) / run.sequence.seconds;
}

void advise_on_lost_camera(const MappingRun& run) {
  const TrackSummary& summary = run.tracking->summary;
  const char* const advice =
      2 * summary.unplaced > summary.frames - summary.tracked
          ? "no frame before shows a place that the map knows; begin where it was made from, and "
            "look at that place for a moment (docs/tracking.md)"
          : "its pictures must overlap and follow one another closely, some 10 to 30 a second; "
            "record slower turns with more frames, or give poses (docs/tracking.md)";
  warn(concat("the camera was followed in ", summary.tracked, " of ", summary.frames,
              " frames only: ", advice));
}

}  // namespace

void report_faults(const MappingRun& run) {
  report_skipped(run.sequence);
  if (run.tracking)
    for (const std::string& doubt : run.tracking->sensor_doubts) warn(doubt);
  if (run.tracking && run.tracking->placing && !run.tracking->placing->doubt.empty())
    warn("no first frame shows a known place, nor do objects tell it: " +
         run.tracking->placing->doubt);
  if (masks_all_absent(run))
    warn(concat("none of the ", run.sequence.frames.size(),
                " frames had masks, so the map tells no objects apart; name a mask file after its "
                "frame or its number, or map with --masks none"));
  if (mostly_blank(run))
    warn(
        concat("the masks of ", run.masks_seen.blank, " of ", run.masks_seen.frames,
               " frames tell nothing: no thing at all, or one that is the whole picture; look at "
               "some, where they come from a folder its images must hold a number for each thing"));
  if (!run.live) return;
  report_bad_frames(run.live->statistics);
  report_bad_masks(run.live->statistics);
  report_encoder(run.live->statistics);
}

nlohmann::json run_json(const std::filesystem::path& map, const MappingRun& run, double fps,
                        const std::optional<Repetition>& repetition) {
  const TileTraffic tiles = tile_traffic(run.timers.summary());
  nlohmann::json report = {{"map", map.string()},
                           {"frames", run.sequence.frames.size()},
                           {"frames_skipped", run.sequence.skipped.size()},
                           {"seconds", run.sequence.seconds},
                           {"fps", frames_per_second(run)},
                           {"mask_frames", run.document.mask_frames},
                           {"masks_blank", run.masks_seen.blank},
                           {"interrupted", interrupted()},
                           {"stages", stages_json(run.timers)},
                           {"tiles_evicted", tiles.evicted},
                           {"tiles_loaded", tiles.loaded},
                           {"embedding_queries", embedding_queries(run.document.semantics)},
                           {"instances", run.document.instances.size()},
                           {"cpu_seconds", cpu_seconds()},
                           {"peak_rss_mb", peak_rss_mb()}};
  report["map_from_recording"] = move_json(run.map_from_recording);
  report["movers"] = movers_json(run.document);
  if (run.people_frames) report["people_frames"] = *run.people_frames;
  if (run.tracking) report["tracking"] = tracking_json(*run.tracking);
  if (run.tracking) report["tracking"]["parts"] = parts_json(run.parts);
  if (repetition)
    report["repeated"] = {{"map", repetition->of.string()},
                          {"same", repetition->differing.empty()},
                          {"differing", repetition->differing}};
  else if (run.live)
    report["live"] = live_json(*run.live, fps);
  return report;
}

void print_run(const std::filesystem::path& map, const MappingRun& run, double fps,
               const std::optional<Repetition>& repetition) {
  std::printf("%s: %zu objects from %zu frames (%d with masks) in %.1f s (%.1f frames/s)\n",
              map.c_str(), run.document.instances.size(), run.sequence.frames.size(),
              run.document.mask_frames, run.sequence.seconds, frames_per_second(run));
  const TileTraffic tiles = tile_traffic(run.timers.summary());
  if (tiles.evicted > 0)
    std::printf("%zu tiles left memory on the way, %zu came back; peak memory %.0f MB\n",
                tiles.evicted, tiles.loaded, peak_rss_mb());
  print_changes(map, run.document.history);
  if (!run.document.movers.empty())
    std::printf("%zu things moved while they were seen\n", run.document.movers.size());
  if (run.people_frames) std::printf("left out people in %zu frames\n", *run.people_frames);
  if (run.map_from_recording) print_move(*run.map_from_recording);
  if (run.tracking) print_tracking(*run.tracking);
  print_parts(run);
  if (repetition)
    print_repetition(*repetition);
  else if (run.live)
    print_live(*run.live, fps);
}

double sent_fps(const LiveRunResult& run) {
  const auto frames = run.statistics.frames_pushed + run.statistics.frames_dropped +
                      static_cast<std::int64_t>(run.sequence.skipped.size());
  return run.camera_seconds > 0 ? static_cast<double>(frames) / run.camera_seconds : 0;
}

bool mostly_lost(const MappingRun& run) {
  if (!run.tracking) return false;
  std::size_t followed = run.tracking->summary.tracked;
  for (const MapPart& part : run.parts) followed += part.frames;
  return 2 * followed < run.tracking->summary.frames;
}

void advise_on_objects(const MappingRun& run) {
  if (mostly_lost(run)) return advise_on_lost_camera(run);
  if (!run.document.instances.empty() || masks_all_absent(run) || mostly_blank(run)) return;
  warn(concat("no object was seen often enough to be kept; map more frames, or --set ",
              run.live ? "live.masks.min_gap" : "mask_interval", "=1 where masks are slow"));
}

void advise_on_encoder(const MappingRun& run,
                       const std::vector<std::filesystem::path>& model_dirs) {
  const std::string& used = run.document.semantics.encoder.name;
  for (const ModelListing& model : list_models(model_search_path(model_dirs)))
    if (!used.empty() && model.name == kDefaultEncoder && model.fault.empty() &&
        read_model_folder(model.folder).name == used)
      warn(concat("words go by the small default encoder; a better one: ovimap models fetch ",
                  kFirstEncoder));
}

void advise_on_writing(const MappingRun& run) {
  if (run.document.semantics.writing_reader.empty() ||
      run.frames_before == run.document.frames.size())
    return;
  warn("what was read on things before is kept; `ovimap read` reads what the new frames show");
}

}  // namespace ovimap::apps
