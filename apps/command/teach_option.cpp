// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "teach_option.h"

#include "ovimap/pipeline/search/teaching.h"

namespace ovimap::apps {

std::filesystem::path TeachOption::file() const {
  if (what == "off") return {};
  return what == "on" ? default_taught_file() : std::filesystem::path(what);
}

void add_teach_option(CLI::App& command, TeachOption& option, const std::string& help) {
  command
      .add_option("--teach", option.what,
                  help + ": on (~/.local/share/ovimap/taught.json), off, or a file")
      ->capture_default_str();
}

}  // namespace ovimap::apps
