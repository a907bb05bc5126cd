// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "ovimap/base/error.h"

namespace ovimap {

/// Says what in `file` of a fetched model is more than ovimap can take.
[[noreturn]] inline void refuse_model(const std::filesystem::path& file, const std::string& what) {
  throw Error(concat(file.string(), ": ", what, "; this model cannot be used"));
}

}  // namespace ovimap
