// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "ovimap/semantics/query/query_grammar.h"
#include "ovimap/semantics/relations/object_measures.h"
#include "ovimap/semantics/words/colors.h"
#include "ovimap/semantics/words/written_words.h"

namespace ovimap {

/// How well an object has what a phrase says of it besides its kind.
struct AttributeRating {
  float score = 1.f;  ///< in [0, 1]; one half is the border
  std::string evidence;
};

/// Adds a clause to what speaks for an answer.
void add_evidence(std::string& evidence, const std::string& clause);
/// "0.02 m above the top of #12, which is 0.30 m from #4"
std::string with_anchor(const std::string& clause, const std::string& anchor_evidence);

/// Plainly of a colour is what shows it on half of its surface; on a quarter is the border.
void rate_color(const SurfaceColors& surface, const ShadedColor& wanted, AttributeRating& rating);

/// Sizes are known to some per cent: the border is the bound itself.
void rate_size(const ObjectMeasures& measures, const SizeBound& size, AttributeRating& rating);

/// What reads as half of the words is the border.
void rate_writing(std::span<const std::u32string> wanted, std::span<const WrittenLine> lines,
                  AttributeRating& rating);

}  // namespace ovimap
