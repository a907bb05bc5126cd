// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <filesystem>
#include <optional>
#include <vector>

#include "ovimap/base/config.h"

namespace ovimap::python {

namespace nb = nanobind;

/// Settings by their dotted names, as {"map.voxel_size_m": 0.02}; `ovimap config` lists them.
using Settings = std::optional<nb::dict>;

/// Sets what `settings` names. Throws Error for an unknown name or a value out of range.
void apply_settings(const Settings& settings, ConfigFields& fields);

template <class Config>
Config configured(const Settings& settings, Config config = {}) {
  ConfigFields fields;
  list_fields(config, fields);
  apply_settings(settings, fields);
  return config;
}

/// Whether it is a string or os.PathLike.
bool is_path(nb::handle path);
/// A path or several, as strings or os.PathLike.
std::filesystem::path to_path(nb::handle path, const char* name);
std::vector<std::filesystem::path> to_paths(nb::handle paths, const char* name);

}  // namespace ovimap::python
