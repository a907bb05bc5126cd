// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/command/command.h"

namespace ovimap::apps {

/// All commands with their options.
class Program {
 public:
  Program();
  /// Does what the arguments after the program's name say; prints faults. Once.
  int run(std::vector<std::string> arguments);
  const CLI::App& app() const { return app_; }

 private:
  CLI::App app_;
  std::map<const CLI::App*, Action> actions_;
};

}  // namespace ovimap::apps
