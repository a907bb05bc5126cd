// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "ovimap/semantics/query/verdict.h"
#include "ovimap/semantics/relations/relations.h"
#include "ovimap/semantics/words/text_evidence.h"

namespace ovimap {

class ConfigFields;

enum class TermRule { kAny, kAll };
enum class NegativeRule { kExclude, kLower };
enum class RankRule { kStandardScore, kCosine };

struct QueryConfig {
  int top_k = 5;                    ///< instances in an answer
  std::string prompts;              ///< templates with {}, separated by |; empty: the encoder's own
  TermRule terms = TermRule::kAny;  ///< which of several terms must match
  NegativeRule negatives = NegativeRule::kExclude;  ///< what a better matching negative does
  RankRule rank_by = RankRule::kStandardScore;      ///< what orders the answer
  int max_text_chars = 2000;                        ///< longer queries are refused
  int max_like_references = 300;  ///< objects that calibrate the search for look-alikes
  VerdictConfig verdict;
  EvidenceConfig evidence;

  bool grammar = true;           ///< "mug on the table" is a relation; false: all is free text
  float candidate_rate = 0.35f;  ///< relations are tried on objects with at most this p-value
  float rival_share = 0.65f;     ///< for "nearest" and "largest" compete objects with at least this
                                 ///< share of the best standard score
  int max_anchors = 16;          ///< objects that an anchor such as "the table" may be
  RelationConfig relations;
};
void list_fields(QueryConfig& config, ConfigFields& fields);

}  // namespace ovimap
