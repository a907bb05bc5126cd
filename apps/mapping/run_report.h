// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mapping_run.h"

namespace ovimap::apps {

/// On stderr: frames that were skipped, masks that were bad, an interruption.
void report_faults(const MappingRun& run);

/// A map that was made again.
struct Repetition {
  std::filesystem::path of;
  std::vector<std::string> differing;  ///< tables in which the two differ; none: the same map
};

/// What a run did, for programs and for people. `fps`: of the camera of a live run.
nlohmann::json run_json(const std::filesystem::path& map, const MappingRun& run, double fps,
                        const std::optional<Repetition>& repetition = std::nullopt);
void print_run(const std::filesystem::path& map, const MappingRun& run, double fps,
               const std::optional<Repetition>& repetition = std::nullopt);

/// Frames a second that a camera or clients sent, also those left out.
double sent_fps(const LiveRunResult& run);

/// Whether the camera was lost for more frames than it was followed, parts counted.
bool mostly_lost(const MappingRun& run);

/// On stderr: that the camera was lost for most frames, or else why the map has no object.
void advise_on_objects(const MappingRun& run);

/// On stderr, where the small default encoder was used: how to get a better one.
void advise_on_encoder(const MappingRun& run, const std::vector<std::filesystem::path>& model_dirs);

/// On stderr, where what an earlier `ovimap read` found was kept: that new frames were not read.
void advise_on_writing(const MappingRun& run);

}  // namespace ovimap::apps
