// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace ovimap::apps {

/// One line on a command line that could not be read: what is unknown in it and what comes nearest,
/// else what the parser says, and where help is. `arguments` without the program's name.
std::string usage_fault(const CLI::App& app, const CLI::ParseError& error,
                        const std::vector<std::string>& arguments);

}  // namespace ovimap::apps
