// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/query_grammar.h"

#include "ovimap/base/error.h"
#include "ovimap/base/text/ascii.h"
#include "ovimap/semantics/query/query_words.h"

namespace ovimap {

namespace {

constexpr const char* kAnyThing = "anything";
constexpr std::size_t kMaxRelations = 16;  // in one query; more is no question but a text

std::optional<QueryPhrase> parse_words(Words words, const QueryAbilities& can);

/// Takes "red" or "dark red" off the front, where one thing follows: of "red chair, sofa" only the
/// chair is red, which is left to the encoder.
std::optional<ShadedColor> take_color(Words& words) {
  for (const std::string& word : words)
    if (word.front() != '"' && word.find(',') != std::string::npos) return std::nullopt;
  std::optional<Shade> shade;
  if (words.size() > 2) shade = shade_of_word(lower_case(words[0]));
  const bool strong = words.size() > 2 && plays(words[0], WordRole::kStrength);
  const std::size_t at = shade || strong ? 1 : 0;
  if (at + 1 >= words.size()) return std::nullopt;
  const std::optional<Color> color = color_of_word(lower_case(words[at]));
  if (!color) return std::nullopt;
  words = words.subspan(at + 1);
  return ShadedColor{*color, shade};
}

/// `[number] [superlative] [color] things [size] [text:"WRITING"]`, at least one thing or writing.
std::optional<QueryPhrase> parse_things(Words words, const QueryAbilities& can) {
  words = without_articles(words);
  QueryPhrase phrase;
  phrase.writing = take_writing(words);
  if (words.empty() && !phrase.writing.empty()) {
    phrase.things = kAnyThing;
    phrase.anything = true;
    return phrase;
  }
  if (words.size() > 1) phrase.count = number_of(words[0]);
  if (phrase.count > 0) words = without_articles(words.subspan(1));
  if (words.size() > 1) phrase.superlative = superlative_of(words[0]);
  if (phrase.superlative) words = without_articles(words.subspan(1));
  phrase.size = take_size(words);
  if (can.colors) phrase.color = take_color(words);
  if (words.empty()) return std::nullopt;
  phrase.things = phrase.count > 0 ? singular(words) : joined(words);
  phrase.anything = words.size() == 1 && plays(words[0], WordRole::kAnything);
  return phrase;
}

/// `A and B`, or `[the two] As`; empty when neither fits.
std::vector<QueryPhrase> parse_pair(Words words, const QueryAbilities& can, bool& same_kind) {
  std::vector<QueryPhrase> anchors;
  for (std::size_t i = 1; i + 1 < words.size(); ++i) {
    if (lower_case(words[i]) != "and") continue;
    const auto first = parse_things(words.first(i), can);
    const auto second = parse_words(words.subspan(i + 1), can);
    if (first && second) return {*first, *second};
  }
  words = without_articles(words);
  if (!words.empty() && plays(words[0], WordRole::kPair)) words = words.subspan(1);
  const auto both = parse_words(words, can);
  if (!both) return {};
  same_kind = true;
  return {*both};
}

/// Reads the relation found at words[at], when there is something on both sides of it.
std::optional<QueryPhrase> parse_relation(Words words, std::size_t at, const FoundRelation& found,
                                          const QueryAbilities& can) {
  Words left = words.first(at);
  const Words right = words.subspan(at + found.length);
  if (relation_at(right).length > 0) return std::nullopt;  // "television on on the wall"
  const bool negated = left.size() > 1 && lower_case(left.back()) == "not";
  if (negated) left = left.first(left.size() - 1);
  const bool part = found.relation == Relation::kPartOf;
  if (part && (negated || !can.parts)) return std::nullopt;
  // Colours are known of objects alone.
  std::optional<QueryPhrase> phrase =
      parse_things(without_fillers(left), {.colors = can.colors && !part, .parts = can.parts});
  if (!phrase) return std::nullopt;
  phrase->relation = found.relation;
  phrase->negated = negated;
  if (part && (phrase->things == "part" || phrase->things == "parts")) phrase->anything = true;
  if (found.relation == Relation::kBetween)
    phrase->anchors = parse_pair(right, can, phrase->same_kind);
  else if (is_place(right))
    return std::nullopt;
  else if (auto anchor = parse_words(right, can))
    phrase->anchors = {*std::move(anchor)};
  if (phrase->anchors.empty()) return std::nullopt;
  return phrase;
}

/// The leftmost relation that has something on both sides splits the words; what is right of it is
/// read the same way.
std::optional<QueryPhrase> parse_words(Words words, const QueryAbilities& can) {
  for (std::size_t at = 1; at < words.size(); ++at) {
    const FoundRelation found = relation_at(words.subspan(at));
    if (found.length == 0) continue;
    if (auto phrase = parse_relation(words, at, found, can)) return phrase;
  }
  return parse_things(words, can);
}

/// "how many chairs [are there] [relation anchor]".
std::optional<QueryPhrase> parse_how_many(Words words, const QueryAbilities& can) {
  if (match_length(words, "how many") == 0) return std::nullopt;
  words = words.subspan(2);
  while (words.size() > 1 && plays(words.back(), WordRole::kCountFiller))
    words = words.first(words.size() - 1);
  std::vector<std::string> asked;  // "chairs are there on the rug": the fillers in the middle go
  for (const std::string& word : words)
    if (!plays(word, WordRole::kCountFiller)) asked.push_back(word);
  std::optional<QueryPhrase> phrase = parse_words(asked, can);
  if (!phrase) return std::nullopt;
  phrase->how_many = true;
  const std::vector<std::string> things = words_of(phrase->things);
  phrase->things = singular(Words(things));
  return phrase;
}

}  // namespace

const char* side_name(Side side) {
  switch (side) {
    case Side::kHeight:
      return "high";
    case Side::kLength:
      return "long";
    case Side::kDepth:
      return "deep";
  }
  return "";
}

QueryPhrase parse_query(std::string_view text, const QueryAbilities& can) {
  const std::vector<std::string> words = words_of(text);
  if (const auto counted = parse_how_many(words, can)) return *counted;
  std::size_t relations = 0;
  for (std::size_t at = 0; at < words.size(); ++at)
    relations += relation_at(Words(words).subspan(at)).length > 0;
  if (relations <= kMaxRelations) {
    const std::optional<QueryPhrase> phrase = parse_words(words, can);
    if (phrase && !phrase->free_text()) return *phrase;
  }
  // Free text goes to the encoder as it was written, articles included.
  QueryPhrase free;
  free.things = joined(words);
  return free;
}

std::string describe(const QueryPhrase& phrase) {
  std::string text;
  if (phrase.how_many) text += "how many ";
  if (phrase.count > 0) text += concat(phrase.count, " ");
  if (phrase.superlative) text += std::string(superlative_name(*phrase.superlative)) + " ";
  if (phrase.color && phrase.color->shade) text += concat(shade_name(*phrase.color->shade), " ");
  if (phrase.color) text += concat(color_name(phrase.color->color), " ");
  text += "[" + phrase.things + "]";
  if (phrase.size)
    text += concat(phrase.size->more ? " more" : " less", " than ", phrase.size->bound_m, " m ",
                   side_name(phrase.size->side));
  if (!phrase.writing.empty()) text += concat(" with the text \"", phrase.writing, "\"");
  if (!phrase.relation) return text;
  text += std::string(phrase.negated ? " not " : " ") + relation_name(*phrase.relation) + " ";
  if (phrase.same_kind) return text + "two of " + describe(phrase.anchors[0]);
  text += describe(phrase.anchors[0]);
  if (phrase.anchors.size() > 1) text += " and " + describe(phrase.anchors[1]);
  return text;
}

const char* relation_name(Relation relation) {
  switch (relation) {
    case Relation::kOn:
      return "on";
    case Relation::kUnder:
      return "under";
    case Relation::kAbove:
      return "above";
    case Relation::kBeside:
      return "beside";
    case Relation::kNear:
      return "near";
    case Relation::kInside:
      return "inside";
    case Relation::kBetween:
      return "between";
    case Relation::kNearest:
      return "nearest to";
    case Relation::kFarthest:
      return "farthest from";
    case Relation::kLeftOf:
      return "left of";
    case Relation::kRightOf:
      return "right of";
    case Relation::kInFrontOf:
      return "in front of";
    case Relation::kBehind:
      return "behind";
    case Relation::kPartOf:
      return "of";
  }
  return "";
}

}  // namespace ovimap
