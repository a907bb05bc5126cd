// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "ovimap/base/config.h"

namespace ovimap {

/// Sets the fields that a YAML file names, as nested maps or dotted keys. Throws Error for a
/// missing or unreadable file, an unknown key (with the nearest known one) or a value out of range.
void load_config(const std::filesystem::path& path, ConfigFields& fields);

}  // namespace ovimap
