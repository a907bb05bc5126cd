// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "command.h"

namespace ovimap::apps {

/// --teach: whether names that people give teach other maps.
struct TeachOption {
  std::string what = "off";  ///< off, on (the file where it is kept by default), or a file

  /// Empty: nothing is taught. Throws Error where no place is known.
  std::filesystem::path file() const;
};

/// `help` says what it does for this command.
void add_teach_option(CLI::App& command, TeachOption& option, const std::string& help);

}  // namespace ovimap::apps
