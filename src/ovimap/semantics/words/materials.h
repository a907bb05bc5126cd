// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ovimap/semantics/words/concepts.h"

namespace ovimap {

/// The words of a text that say what a thing is made of, or its pattern, before the thing itself:
/// "wooden" of "wooden table", in lower case. None of what is the name of a kind of thing, as a
/// wooden spoon is, nor of a material by itself ("glass"). docs/query.md says why they are told
/// apart.
std::vector<std::string> material_words(std::string_view text, const Concepts& concepts);

}  // namespace ovimap
