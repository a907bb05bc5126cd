// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>

#include "ablation.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/pipeline/sequence/timings_text.h"

namespace ovimap::apps {

namespace {

struct PaperStage {
  const char* name;
  const char* thread;                 ///< of ours
  double published_ms;                ///< supplement, on an i7-12700K with an RTX 3090; 0: none
  int published_every;                ///< every so many frames
  std::array<const char*, 2> stages;  ///< ours that do this work; "": none
};

constexpr std::array kStages{
    PaperStage{"2D masks", "mapper", 964.8, 30, {"masks", ""}},
    PaperStage{"depth segmentation", "mapper", 88.4, 30, {"surface", "regions"}},
    PaperStage{"2D-3D association", "mapper", 76.3, 30, {"associate", "registry"}},
    PaperStage{"fusion", "mapper", 0, 1, {"allocate", "integrate"}},
    PaperStage{"view selection", "mapper", 140.8, 10, {"project", "views"}},
    PaperStage{"view features", "encoder's", 131.3, 10, {"embed", ""}},
};

/// The mean over maps of the sum of what the stages take in the median, and how often they ran.
struct StageCost {
  double p50_ms = 0, p95_ms = 0;
  std::size_t count = 0;
};

StageCost cost_of(const PaperStage& stage, const std::vector<std::filesystem::path>& maps) {
  StageCost cost;
  for (const auto& map : maps) {
    const auto timings = parse_timings(load_map(map).timings);
    for (const char* name : stage.stages) {
      const auto found = timings.find(name);
      if (found == timings.end()) continue;
      cost.p50_ms += found->second.p50_ms / static_cast<double>(maps.size());
      cost.p95_ms += found->second.p95_ms / static_cast<double>(maps.size());
      if (name == stage.stages[0]) cost.count += found->second.count;
    }
  }
  return cost;
}

}  // namespace

std::string timing_markdown(const std::vector<std::filesystem::path>& maps,
                            const std::string& heading) {
  std::string text = concat("## What the stages take\n\n", heading,
                            "\n\n| stage | thread | p50, ms | p95, ms | times | published, ms | "
                            "published: every |\n| --- | "
                            "--- | --- | --- | --- | --- | --- |\n");
  for (const PaperStage& stage : kStages) {
    const StageCost cost = cost_of(stage, maps);
    char line[160];
    std::snprintf(line, sizeof line, "| %s | %s | %.1f | %.1f | %zu |", stage.name, stage.thread,
                  cost.p50_ms, cost.p95_ms, cost.count);
    text += line;
    if (stage.published_ms > 0)
      text += concat(" *", stage.published_ms, "* | *", stage.published_every, "* |\n");
    else
      text += " - | - |\n";
  }
  return text;
}

}  // namespace ovimap::apps
