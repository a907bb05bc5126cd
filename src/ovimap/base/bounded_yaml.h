// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "ovimap/base/bounded_text.h"

namespace YAML {
class Node;
}

namespace ovimap {

/// YAML from outside: the one way in which ovimap reads it. Accepted is one document, nested at
/// most kDeepestDocument deep, whose maps have texts as keys and each of them once, without aliases
/// (*name): with these a document can contain itself, or a small one is walked as a huge one. An
/// empty text is null. `name` names the text in faults: "PATH", "the body". Throws Error, one line
/// that says where the text goes wrong.
YAML::Node parse_yaml(const std::string& text, const std::string& name, std::size_t most_bytes);

/// Likewise a file.
YAML::Node read_yaml(const std::filesystem::path& file, std::size_t most_bytes);

}  // namespace ovimap
