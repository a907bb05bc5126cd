// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ovimap {

/// The text of data/NAME.txt, compiled in: "vocabulary", "concepts", "thing_sizes",
/// "seen_sizes", "replica51", "scannet200", "scannet20", "scannet200_groups", "room_classes",
/// "room_kinds". Empty for any other name.
std::string_view builtin_word_list(std::string_view name);

/// One entry a line, without blanks around it; empty lines and those that begin with # are left
/// out.
std::vector<std::string> list_entries(std::string_view text);

}  // namespace ovimap
