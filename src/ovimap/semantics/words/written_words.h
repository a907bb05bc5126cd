// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ovimap/semantics/views/appearance.h"

namespace ovimap {

/// Of every text, whatever the case of its letters, the surest reading. Surest first.
std::vector<WrittenLine> surest_readings(std::vector<WrittenLine> lines);

/// What is written on an object, by all its views.
std::vector<WrittenLine> writing_of(const Appearance& appearance);

/// A text in words of letters, numbers and the signs that names have ("C++", "R&D"), lower case,
/// without articles, unless there is nothing else.
std::vector<std::u32string> written_words(std::string_view text);

struct WritingMatch {
  float share = 0;                    ///< how much of the words was read, in [0, 1]
  const WrittenLine* line = nullptr;  ///< where the best of them was read; null: nowhere
};

/// How well `wanted` is written in `lines`: the mean over its words of the best reading's
/// confidence times likeness. A reading may err in one character of four; of words of up to three
/// none.
WritingMatch match_writing(std::span<const std::u32string> wanted,
                           std::span<const WrittenLine> lines);

}  // namespace ovimap
