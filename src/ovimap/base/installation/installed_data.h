// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace ovimap {

/// The folder `share/ovimap/NAME` that was installed with `code`, a program or a loadable module:
/// beside it, or beside the folder that it lies in, as bin. Nothing where there is none.
std::optional<std::filesystem::path> data_installed_with(const std::filesystem::path& code,
                                                         const std::string& name);

/// The same for the program that runs, else for the loadable module that this function is part of:
/// so a Python package finds what its wheel brought.
std::optional<std::filesystem::path> installed_data(const std::string& name);

}  // namespace ovimap
