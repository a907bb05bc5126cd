// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "ovimap/semantics/words/concepts.h"

namespace ovimap {

/// The household word that was probably meant by a text of which no word is known ("chiar":
/// chair): one letter in four differs from its last word at most, swapped neighbours count as one.
/// Empty when there is none.
std::string meant_word(std::string_view text, const Concepts& concepts);

}  // namespace ovimap
