// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ovimap/semantics/relations/relations.h"

namespace ovimap {

/// A query as understood: `[superlative] things [[not] relation anchor [and anchor]]`. Without
/// superlative and relation it is free text.
struct QueryPhrase {
  std::optional<Superlative> superlative;
  std::string things;     ///< what is looked for; terms may be separated by commas
  bool anything = false;  ///< "object", "anything": geometry alone decides
  std::optional<Relation> relation;
  bool negated = false;              ///< "not on"
  std::vector<QueryPhrase> anchors;  ///< one; two for kBetween, or one of which it takes two:
  bool same_kind = false;            ///< "between the chairs"

  bool free_text() const { return !superlative && !relation; }
};

/// Reads `text` by the grammar of docs/query.md. Whatever does not fit it is free text: every text
/// that names something has a reading. Text between double quotes is never taken for grammar.
QueryPhrase parse_query(std::string_view text);

/// The reading in one line, for people: "largest [cabinet] under [window]".
std::string describe(const QueryPhrase& phrase);

/// "on", "nearest to", ...
const char* relation_name(Relation relation);

}  // namespace ovimap
