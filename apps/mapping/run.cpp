// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/command/save_again.h"
#include "camera_run.h"
#include "mapping_run.h"
#include "ovimap/base/parallel.h"
#include "ovimap/io/map_file/map_check.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/pipeline/report/map_pictures.h"
#include "ovimap/pipeline/sequence/trajectory_file.h"
#include "ovimap/semantics/past/time_words.h"
#include "run_parts.h"
#include "run_report.h"

namespace ovimap::apps {

namespace {

struct RunOptions {
  MappingOptions mapping;
  std::filesystem::path map, continued, repeated;
  std::filesystem::path pictures, trajectory;
  std::string recorded;
  bool json = false;
  bool live = false;
  bool resume = false;
  bool align = false;
  double fps = 30;
};

/// When the recording began, as --recorded says.
double recorded_s(const std::string& text) {
  const TimeAsked time = time_of_text(text, seconds_now());
  if (time.visit == 0) return time.begin_s;
  throw Error(concat("--recorded '", text, "' is no date; give one such as 2026-03-14T09:30"));
}

/// Throws Error for what only a recording has.
void check_for_camera(const RunOptions& options) {
  const auto refuse = [](bool given, const char* option) {
    if (given)
      throw Error(
          concat(option, " is for recordings; leave it away where a camera sends the frames"));
  };
  refuse(!options.repeated.empty(), "--repeat");
  refuse(!options.pictures.empty(), "--pictures");
  refuse(options.align, "--align");
}

MappingRun map_source(const RunOptions& options, const RunTarget& target,
                      std::optional<CameraRun>& camera) {
  if (camera)
    return map_live(options.mapping, 0, target, nullptr, &camera->intake(), &camera->feed());
  if (options.live || !options.repeated.empty())
    return map_live(options.mapping, options.fps, target);
  return map_recording(options.mapping, "mapping", {}, target);
}

int run(RunOptions options) {
  if (options.map.empty()) options.map = options.continued;
  if (options.map.empty())
    throw Error("say where the map goes with -o, or which one to go on with by --continue");
  if (!options.recorded.empty()) options.mapping.recorded_s = recorded_s(options.recorded);
  const ThreadLimit limit(options.mapping.threads);
  check_map_target(options.map);
  if (!options.pictures.empty()) make_folder(options.pictures);
  const RunTarget target{options.map, options.resume, options.continued, options.align,
                         options.repeated};
  std::optional<CameraRun> camera;
  if (names_camera(options.mapping.source))
    check_for_camera(options), camera.emplace(options.mapping);
  const bool replaces = replaces_a_map(target);
  MappingRun mapped = map_source(options, target, camera);
  if (interrupted() && replaces && !mapped.live)
    throw Error(concat(
        "interrupted; '", options.map.string(), "' is the map that was there before",
        holds_checkpoint(checkpoint_path(options.map)) ? "; --resume goes on with this run" : ""));
  const double fps = camera ? sent_fps(*mapped.live) : options.fps;
  report_faults(mapped);
  save_again(target.continued, target.map, mapped.document);
  mapped.checkpoints->remove();
  if (!mapped.live) mapped.parts = map_parts(options.mapping, options.map, mapped);
  if (!options.trajectory.empty()) write_trajectory(options.trajectory, mapped.document.frames);
  if (!options.pictures.empty())
    write_map_pictures(options.pictures, mapped.document, *mapped.source);
  std::optional<Repetition> repetition;
  if (!options.repeated.empty())
    repetition = {options.repeated, differing_tables(options.repeated, options.map)};
  if (options.json)
    print_json(run_json(options.map, mapped, fps, repetition));
  else
    print_run(options.map, mapped, fps, repetition);
  advise_on_objects(mapped);
  advise_on_encoder(mapped, options.mapping.model_dirs);
  advise_on_writing(mapped);
  if (repetition && !repetition->differing.empty()) return kAnswerIsNo;
  const bool frames_missed = camera && !camera->report_loss();
  return frames_missed || mostly_lost(mapped) ? kAnswerIsNo : kDone;
}

}  // namespace

Action add_run(CLI::App& command) {
  auto options = std::make_shared<RunOptions>();
  add_mapping_options(command, options->mapping);
  command.get_option("SOURCE")->description(
      "recording: a folder of a known layout (see docs/sources.md); or openni: for a camera that "
      "is "
      "plugged in (docs/cameras.md)");
  command.add_option("-o,--output", options->map,
                     "map file to write; with --continue the map itself where it is not given");
  command.add_option("--pictures", options->pictures, "folder for a top view and a contact sheet");
  auto* live = command.add_flag("--live", options->live,
                                "take frames at a camera's pace and leave out what comes too late");
  command.add_option("--fps", options->fps, "that pace, frames a second")
      ->check(CLI::Range(0.1, 1000.))
      ->needs(live)
      ->capture_default_str();
  auto* repeat =
      command
          .add_option(
              "--repeat", options->repeated,
              "the map of a live run of this recording: map it again as that run did, with the "
              "frames that it took and the masks when they came, and say whether it is the same "
              "map")
          ->excludes(live);
  auto* continued =
      command
          .add_option(
              "--continue", options->continued,
              "a map of the same place to go on with, in whose world frame the recording's poses "
              "are: what is gone leaves it, ids, names and corrections stay")
          ->excludes(repeat);
  command
      .add_flag("--align", options->align,
                "the recording's poses are in a world frame of their own: move them to where its "
                "surface and objects lie in that map")
      ->needs(continued);
  command.add_option(
      "--recorded", options->recorded,
      "when the recording was made, as 2026-03-14T09:30 or \"yesterday evening\", so that the "
      "map's history has dates; without, frames whose times are dates say it");
  add_poses(command, options->mapping);
  command.add_option("--trajectory", options->trajectory,
                     "file to write the camera's poses to, a TUM line for each frame in the map");
  add_max_memory(command, options->mapping);
  command
      .add_flag("--resume", options->resume,
                "go on with the frames that a killed run, or the map, does not have yet")
      ->excludes(repeat);
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return run(*options); };
}

}  // namespace ovimap::apps
