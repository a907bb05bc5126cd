// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "save_run.h"

#include <cstdio>

#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/map_file/map_file.h"

namespace ovimap::apps {

void save_run(const RunTarget& target, MappingRun& run) {
  std::error_code ignored;
  if (!target.continued.empty() &&
      std::filesystem::equivalent(target.map, target.continued, ignored))
    for (const std::string& lost : carry_later_edits(target.map, run.document))
      warn("a correction made meanwhile fits the map no more: " + lost);
  save_map(target.map, run.document);
}

}  // namespace ovimap::apps
