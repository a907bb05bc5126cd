// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "command.h"

namespace ovimap::apps {

/// The options that decide what a map becomes, one a line.
std::string settings_text(const MappingOptions& mapping);

/// Maps that a folder keeps are known by their names alone; what all of them share must not change.
/// Writes settings.txt, or throws Error when the one that is there says something else.
void require_same_settings(const std::filesystem::path& folder, const std::string& settings);

}  // namespace ovimap::apps
