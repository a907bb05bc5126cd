// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/command/save_again.h"

#include <string>

#include "apps/command/command.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/map_file/map_file.h"

namespace ovimap::apps {

void save_again(const std::filesystem::path& made_of, const std::filesystem::path& out,
                MapDocument& document) {
  std::error_code ignored;
  if (made_of.empty() || !std::filesystem::equivalent(made_of, out, ignored))
    return save_map(out, document);
  for (const std::string& lost : replace_map(out, document))
    warn("a correction made meanwhile fits the map no more: " + lost);
}

}  // namespace ovimap::apps
