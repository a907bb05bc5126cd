// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ovimap {

/// Letters to put in, take out, replace or swap with the next until `a` is `b`, each letter touched
/// once (optimal string alignment): bytes, or characters.
std::size_t edit_distance(std::string_view a, std::string_view b);
std::size_t edit_distance(std::u32string_view a, std::u32string_view b);

/// The candidate, all in small letters, that `word` was probably meant to be: the nearest one, if
/// only some letters differ (one in four, and one more) or if `word` begins it; empty when there is
/// none.
std::string likely_word(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace ovimap
