// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "apps/command/command.h"
#include "ovimap/pipeline/sequence/trajectory_file.h"

namespace ovimap::apps {

namespace {

struct PosesOptions {
  std::filesystem::path estimate, truth;
  double max_gap_s = 0.01;
  bool json = false;
};

/// The poses of a TUM file, or those that a recording gives its frames.
std::vector<TimedPose> true_poses(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return read_timed_poses(path);
  const auto source = open_frame_source(path);
  std::vector<TimedPose> poses;
  Progress progress("reading poses");
  for (std::int64_t i = 0; i < source->size(); ++i) {
    const FrameRead read = source->read(i);
    if (read.frame) poses.push_back({read.frame->timestamp_s, read.frame->world_from_camera});
    progress.show(static_cast<std::size_t>(i + 1), static_cast<std::size_t>(source->size()));
  }
  return poses;
}

nlohmann::json statistics_json(const ErrorStatistics& errors) {
  return {
      {"rmse", errors.rmse}, {"mean", errors.mean}, {"median", errors.median}, {"max", errors.max}};
}

void print_scores(const TrajectoryScores& scores) {
  std::printf("%zu of %zu true poses matched (%.1f%%), %.2f m of way\n", scores.matched,
              scores.truth_poses,
              100. * static_cast<double>(scores.matched) / static_cast<double>(scores.truth_poses),
              scores.path_m);
  std::printf("ATE  rmse %.2f cm, mean %.2f, median %.2f, max %.2f\n", 100 * scores.ate_m.rmse,
              100 * scores.ate_m.mean, 100 * scores.ate_m.median, 100 * scores.ate_m.max);
  std::printf("RPE  rmse %.2f mm and %.3f degrees a frame\n", 1000 * scores.step_m.rmse,
              scores.step_deg.rmse);
  std::printf("end  %.2f cm off, seen from the start\n", 100 * scores.closure_m);
}

int eval_poses(const PosesOptions& options) {
  const std::vector<TimedPose> truth = true_poses(options.truth);
  const TrajectoryScores scores =
      score_trajectory(truth, read_timed_poses(options.estimate), options.max_gap_s);
  if (!options.json) {
    print_scores(scores);
    return kDone;
  }
  print_json({{"truth_poses", scores.truth_poses},
              {"matched", scores.matched},
              {"path_m", scores.path_m},
              {"closure_m", scores.closure_m},
              {"ate_m", statistics_json(scores.ate_m)},
              {"rpe_m", statistics_json(scores.step_m)},
              {"rpe_deg", statistics_json(scores.step_deg)}});
  return kDone;
}

}  // namespace

Action add_eval_poses(CLI::App& command) {
  auto options = std::make_shared<PosesOptions>();
  command.add_option("ESTIMATE", options->estimate, "poses to judge, TUM lines (run --trajectory)")
      ->required();
  command.add_option("TRUTH", options->truth, "true poses: TUM lines, or a recording with poses")
      ->required();
  command
      .add_option("--max-gap", options->max_gap_s,
                  "most time between a pose and its truth, seconds")
      ->check(CLI::Range(0., 10.))
      ->capture_default_str();
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return eval_poses(*options); };
}

}  // namespace ovimap::apps
