// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ovimap/semantics/relations/relations.h"
#include "ovimap/semantics/words/colors.h"

namespace ovimap {

enum class Side { kHeight, kLength, kDepth };

/// "longer than 1.5 m".
struct SizeBound {
  Side side = Side::kHeight;
  bool more = true;  ///< than the bound; false: less
  float bound_m = 0;
};

/// "red", "dark blue".
struct ShadedColor {
  Color color = Color::kBlack;
  std::optional<Shade> shade = std::nullopt;
};

/// A query as understood: `[number] [superlative] [color] things [size] [text:"WRITING"] [[not]
/// relation anchor [and anchor]]`. With things alone it is free text.
struct QueryPhrase {
  bool how_many = false;  ///< "how many chairs"
  int count = 0;          ///< "two chairs"; 0: not said
  std::optional<Superlative> superlative;
  std::optional<ShadedColor> color;
  std::optional<SizeBound> size;
  std::string writing;    ///< what is written on it: text:"exit"; empty: not said
  std::string things;     ///< what is looked for; terms may be separated by commas
  bool anything = false;  ///< "object", "anything": geometry alone decides
  std::optional<Relation> relation;
  bool negated = false;              ///< "not on"
  std::vector<QueryPhrase> anchors;  ///< one; two for kBetween, or one of which it takes two:
  bool same_kind = false;            ///< "between the chairs"

  bool free_text() const {
    return !superlative && !relation && !color && !size && !how_many && count == 0 &&
           writing.empty();
  }
};

/// What a map can be asked for beside things; else the words are the encoder's.
struct QueryAbilities {
  bool colors = true;  ///< colour words before a thing are read as its colour
  bool parts = true;   ///< "drawer of the cabinet" is read as a part of an object
};

/// Reads `text` by the grammar of docs/query.md. Whatever does not fit it is free text: every text
/// that names something has a reading. Text between double quotes is never taken for grammar.
QueryPhrase parse_query(std::string_view text, const QueryAbilities& abilities = {});

/// The reading in one line, for people: "largest [cabinet] under [window]".
std::string describe(const QueryPhrase& phrase);

/// "high", "long", "deep".
const char* side_name(Side side);

/// "on", "nearest to", ...
const char* relation_name(Relation relation);

}  // namespace ovimap
