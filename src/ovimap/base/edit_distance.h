// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ovimap {

/// Letters to put in, take out or replace until `a` is `b` (Levenshtein): bytes, or characters.
std::size_t edit_distance(std::string_view a, std::string_view b);
std::size_t edit_distance(std::u32string_view a, std::u32string_view b);

/// The candidate that `word` was probably meant to be: the nearest one, if only some letters differ
/// (one in four, and one more) or if `word` begins it; empty when there is none.
std::string likely_word(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace ovimap
