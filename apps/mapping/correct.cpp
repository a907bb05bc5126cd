// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <numbers>

#include "apps/command/command.h"
#include "apps/command/save_again.h"
#include "ovimap/base/parallel.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/pipeline/revise/map_correction.h"
#include "ovimap/pipeline/revise/pose_match.h"

namespace ovimap::apps {

namespace {

struct CorrectOptions {
  std::filesystem::path map, poses, out;
  double max_gap_s = 0.02;
  int threads = 0;
  bool json = false;
};

int correct_map(const CorrectOptions& options) {
  const ThreadLimit limit(options.threads);
  const std::filesystem::path out = options.out.empty() ? options.map : options.out;
  MapDocument document = load_map(options.map);
  if (document.unfinished)
    throw Error(concat("map '", options.map.string(),
                       "' is a checkpoint of a run; --resume that run first"));
  check_map_target(out);
  const std::vector<Pose> poses = match_poses(document.frames, options.poses, options.max_gap_s);
  const std::size_t objects_before = document.instances.size();
  PoseCorrection done;
  {
    Progress progress("fusing again");
    done =
        correct_poses(document, poses, config_of_map(document.config_text),
                      [&](std::size_t count, std::size_t total) { progress.show(count, total); });
  }
  save_again(options.map, out, document);
  const double widest_deg = done.widest_rad * 180 / std::numbers::pi;
  if (options.json)
    print_json({{"map", out.string()},
                {"frames", document.frames.size()},
                {"frames_moved", done.moved},
                {"frames_refused", done.refused},
                {"blocks_refused", done.blocks},
                {"blocks", document.map.block_count()},
                {"furthest_m", done.furthest_m},
                {"widest_deg", widest_deg},
                {"instances_before", objects_before},
                {"instances", document.instances.size()}});
  else
    std::printf(
        "%s: %zu of %zu frames moved, by up to %.3f m and %.2f degrees; %zu kept frames are fused "
        "again into %zu of %zu blocks, %zu objects (%zu before)\n",
        out.c_str(), done.moved, document.frames.size(), done.furthest_m, widest_deg, done.refused,
        done.blocks, document.map.block_count(), document.instances.size(), objects_before);
  return kDone;
}

}  // namespace

Action add_correct(CLI::App& command) {
  auto options = std::make_shared<CorrectOptions>();
  command.add_option("MAP", options->map, "map file that keeps frames (frame_store.max_mb)")
      ->required();
  command
      .add_option(
          "--poses", options->poses,
          "corrected poses, one a line: TUM, KITTI or 4x4, of the depth camera in the world")
      ->required();
  command
      .add_option("--max-gap", options->max_gap_s,
                  "most time between a frame and its pose, seconds")
      ->check(CLI::Range(0., 10.))
      ->capture_default_str();
  command.add_option("-o,--output", options->out, "map file to write; without it MAP is replaced");
  command.add_option("--threads", options->threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return correct_map(*options); };
}

}  // namespace ovimap::apps
