// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "ovimap/base/bounded_text.h"

namespace ovimap {

/// JSON from outside: the one way in which ovimap reads it. Accepted is RFC 8259 in UTF-8, nested
/// at most kDeepestDocument deep, with every key once in its object: of two readers, one might
/// take the first value and the other the last. NaN, infinities, numbers beyond the range of a
/// double, comments and lone surrogates are not JSON. The parser does not recurse, and whoever
/// walks what it returns recurses no deeper than that. `name` names the text in faults: "PATH",
/// "the body". Throws Error, one line that says where the text goes wrong.
nlohmann::json parse_json(std::string_view text, const std::string& name, std::size_t most_bytes);

/// Likewise a file.
nlohmann::json read_json(const std::filesystem::path& file, std::size_t most_bytes);

}  // namespace ovimap
