// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ovimap/geometry/camera.h"

namespace ovimap {

using Names = std::vector<const char*>;

/// The first of `names` that exists in `folder`, as a folder or as a file; empty when none does.
std::filesystem::path find_one(const std::filesystem::path& folder, const Names& names,
                               bool as_folder);

/// The files with one of the extensions (".jpg"), in natural order.
std::vector<std::filesystem::path> list_files(const std::filesystem::path& folder,
                                              const Names& extensions);

/// `source` itself, or the one file with the extension (".oni") in it; empty when there is none.
/// Throws Error where there are several.
std::filesystem::path find_file(const std::filesystem::path& source, const char* extension);

/// For each colour file its partner in `folder`: of equal stem or, when no stem agrees, of equal
/// rank. A colour file whose partner is missing gets the path where it should be. Throws Error when
/// no stem agrees and the counts differ.
std::vector<std::filesystem::path> partner_files(const std::vector<std::filesystem::path>& colors,
                                                 const std::filesystem::path& folder,
                                                 const std::string& extension);

/// Sets fx, fy, cx, cy from a text file with these four numbers or a 3x3 or 4x4 matrix. Throws
/// Error when it holds anything else.
void read_text_intrinsics(const std::filesystem::path& file, PinholeCamera& camera);

}  // namespace ovimap
