// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace ovimap {

/// The digest that git gives a file's content, 40 hexadecimal digits: SHA-1 of "blob SIZE", a zero
/// byte and the content. Throws Error when the file cannot be read.
std::string git_blob_of_file(const std::filesystem::path& file);

}  // namespace ovimap
