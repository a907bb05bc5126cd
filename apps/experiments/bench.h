// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/command/command.h"
#include "ovimap/map/surface/incremental_mesh.h"

namespace ovimap::apps {

/// What keeps a map within the bound, in a file among other temporary ones that goes with it; null
/// when there is no bound.
std::unique_ptr<Checkpointer> bound_memory(const MemoryConfig& memory);

std::string processor_name();

/// Removes the file or folder when it goes out of scope, whatever happened meanwhile.
struct RemoveLater {
  std::filesystem::path path;
  ~RemoveLater();
};

/// Among other temporary files, of this process alone and another one at every call.
std::filesystem::path temporary_path(const std::string& ending);

/// Tells what this machine can do, on a walk through a room that is rendered for it: frames a
/// second at 1 and 2 cm and with poses found, what masks and words take, and what limits it.
int bench_machine(const ProgramConfig& config, MappingOptions options, bool json);

struct CorridorBench {
  int frames;
  bool again;  ///< walk it once more, as another visit of the map
  bool track;  ///< poses are found
  bool json;
};

/// Walks down a generated corridor with voxels of 4 cm, and reports for every tenth of the frames
/// what one costs, stage by stage, and how large the map is.
int bench_corridor(const CorridorBench& wanted, ProgramConfig config,
                   const MappingOptions& options);

}  // namespace ovimap::apps
