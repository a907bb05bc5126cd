// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/query_config.h"

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
  fields.add("grammar", config.grammar, "read relations and superlatives; false: all is free text");
  fields.add("candidate_rate", config.candidate_rate, 1e-6f, 1.f,
             "relations are tried on objects with at most this p-value");
  fields.add(
      "rival_share", config.rival_share, 0.f, 1.f,
      "\"nearest\" and \"largest\" compare objects with this share of the best score or more");
  fields.add("max_anchors", config.max_anchors, 1, kMost,
             "objects that an anchor of a relation may be");
  fields.group("relations", [&](ConfigFields& inner) { list_fields(config.relations, inner); });
  fields.group("verdict", [&](ConfigFields& inner) { list_fields(config.verdict, inner); });
  fields.group("evidence", [&](ConfigFields& inner) { list_fields(config.evidence, inner); });
}

}  // namespace ovimap
