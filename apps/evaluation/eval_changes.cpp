// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "apps/command/command.h"
#include "ovimap/base/parallel.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/pipeline/evaluation/change_evaluation.h"

namespace ovimap::apps {

namespace {

struct EvalChangesOptions {
  std::filesystem::path map, visits;
  int threads = 0;
  bool json = false;
};

nlohmann::ordered_json counts_json(const ChangeCounts& counts) {
  return {{"real", counts.real},
          {"told", counts.told},
          {"right", counts.right},
          {"precision", counts.precision()},
          {"recall", counts.recall()}};
}

void print_counts(const char* kind, const ChangeCounts& counts) {
  std::printf("%-8s %4zu %4zu %5zu %9.2f %6.2f\n", kind, counts.real, counts.told, counts.right,
              counts.precision(), counts.recall());
}

int eval_changes(const EvalChangesOptions& options) {
  const ThreadLimit limit(options.threads);
  const ChangeScores scores = score_changes(load_map(options.map), options.visits);
  if (options.json) {
    print_json({{"ghost", scores.ghost()},
                {"left_points", scores.left_points},
                {"static_kept", scores.kept()},
                {"static_points", scores.static_points},
                {"mover_left", scores.mover_share()},
                {"mover_points", scores.mover_points},
                {"mover_knowable_points", scores.knowable_points},
                {"moved", counts_json(scores.moved)},
                {"removed", counts_json(scores.removed)},
                {"added", counts_json(scores.added)},
                {"ids_kept", scores.ids_kept},
                {"in_doubt", scores.in_doubt}});
    return kDone;
  }
  std::printf("surface of what left: %.1f %% of %zu points that were looked through\n",
              100 * scores.ghost(), scores.left_points);
  std::printf("surface of what stayed: %.1f %% of %zu points\n", 100 * scores.kept(),
              scores.static_points);
  if (scores.mover_points > 0)
    std::printf(
        "surface of what moved while it was seen: %.2f %% of %zu points, %.2f %% of which "
        "frames looked through\n",
        100 * scores.mover_share(), scores.mover_points,
        100 * static_cast<double>(scores.knowable_points) /
            static_cast<double>(scores.mover_points));
  std::printf("%-8s %4s %4s %5s %9s %6s\n", "kind", "real", "told", "right", "precision", "recall");
  print_counts("moved", scores.moved);
  print_counts("removed", scores.removed);
  print_counts("added", scores.added);
  std::printf("moved under the id that it had: %zu of %zu, and %zu in doubt\n", scores.ids_kept,
              scores.moved.real, scores.in_doubt);
  return kDone;
}

}  // namespace

Action add_eval_changes(CLI::App& command) {
  auto options = std::make_shared<EvalChangesOptions>();
  command.add_option("MAP", options->map, "map that was continued through all visits")->required();
  command.add_option("VISITS", options->visits, "folder that `ovimap synth --visits` wrote")
      ->required();
  command.add_option("--threads", options->threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return eval_changes(*options); };
}

}  // namespace ovimap::apps
