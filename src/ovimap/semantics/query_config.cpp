// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query_config.h"

#include "ovimap/base/config.h"

namespace ovimap {

void list_fields(QueryConfig& config, ConfigFields& fields) {
  constexpr int kMost = 1000000;
  fields.add("top_k", config.top_k, 1, kMost, "instances in an answer");
  fields.add("prompts", config.prompts,
             "text templates with {}, separated by |; empty: the encoder's own");
  fields.add_choice("terms", config.terms, {{"any", TermRule::kAny}, {"all", TermRule::kAll}},
                    "which of several terms, separated by commas, an object must match");
  fields.add_choice("negatives", config.negatives,
                    {{"exclude", NegativeRule::kExclude}, {"lower", NegativeRule::kLower}},
                    "what becomes of an object that a negative text matches better");
  fields.add_choice("rank_by", config.rank_by,
                    {{"standard", RankRule::kStandardScore}, {"cosine", RankRule::kCosine}},
                    "what orders the instances of an answer");
  fields.add("max_text_chars", config.max_text_chars, 1, kMost,
             "queries of more characters are refused");
  fields.add("max_like_references", config.max_like_references, 1, kMost,
             "objects that calibrate the search for look-alikes");
  fields.group("verdict", [&](ConfigFields& inner) { list_fields(config.verdict, inner); });
}

}  // namespace ovimap
