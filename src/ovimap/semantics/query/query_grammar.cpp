// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/query_grammar.h"

#include <algorithm>
#include <array>
#include <span>

namespace ovimap {

namespace {

using Words = std::span<const std::string>;

struct RelationWords {
  std::string_view words;
  Relation relation;
};

// Longer phrases before those they begin with.
constexpr std::array kRelations{
    RelationWords{"on top of", Relation::kOn},
    RelationWords{"on the top of", Relation::kOn},
    RelationWords{"on the left side of", Relation::kLeftOf},
    RelationWords{"on the left of", Relation::kLeftOf},
    RelationWords{"to the left of", Relation::kLeftOf},
    RelationWords{"left of", Relation::kLeftOf},
    RelationWords{"on the right side of", Relation::kRightOf},
    RelationWords{"on the right of", Relation::kRightOf},
    RelationWords{"to the right of", Relation::kRightOf},
    RelationWords{"right of", Relation::kRightOf},
    RelationWords{"in front of", Relation::kInFrontOf},
    RelationWords{"behind", Relation::kBehind},
    RelationWords{"on", Relation::kOn},
    RelationWords{"upon", Relation::kOn},
    RelationWords{"under", Relation::kUnder},
    RelationWords{"underneath", Relation::kUnder},
    RelationWords{"below", Relation::kUnder},
    RelationWords{"beneath", Relation::kUnder},
    RelationWords{"above", Relation::kAbove},
    RelationWords{"over", Relation::kAbove},
    RelationWords{"next to", Relation::kBeside},
    RelationWords{"beside", Relation::kBeside},
    RelationWords{"alongside", Relation::kBeside},
    RelationWords{"by", Relation::kBeside},
    RelationWords{"near to", Relation::kNear},
    RelationWords{"near", Relation::kNear},
    RelationWords{"close to", Relation::kNear},
    RelationWords{"inside of", Relation::kInside},
    RelationWords{"inside", Relation::kInside},
    RelationWords{"within", Relation::kInside},
    RelationWords{"in", Relation::kInside},
    RelationWords{"in between", Relation::kBetween},
    RelationWords{"between", Relation::kBetween},
    RelationWords{"nearest to", Relation::kNearest},
    RelationWords{"nearest", Relation::kNearest},
    RelationWords{"closest to", Relation::kNearest},
    RelationWords{"closest", Relation::kNearest},
    RelationWords{"farthest from", Relation::kFarthest},
    RelationWords{"furthest from", Relation::kFarthest},
};

struct SuperlativeWord {
  std::string_view word;
  Superlative superlative;
};

constexpr std::array kSuperlatives{
    SuperlativeWord{"largest", Superlative::kLargest},
    SuperlativeWord{"biggest", Superlative::kLargest},
    SuperlativeWord{"smallest", Superlative::kSmallest},
    SuperlativeWord{"tallest", Superlative::kTallest},
    SuperlativeWord{"shortest", Superlative::kShortest},
    SuperlativeWord{"highest", Superlative::kHighest},
    SuperlativeWord{"topmost", Superlative::kHighest},
    SuperlativeWord{"lowest", Superlative::kLowest},
};

constexpr std::array<std::string_view, 3> kArticles{"a", "an", "the"};
constexpr std::array<std::string_view, 9> kAnything{
    "object", "objects", "thing", "things", "anything", "something", "item", "items", "everything"};
// What may stand between a thing and its relation: "the mug that is standing on ...".
constexpr std::array<std::string_view, 14> kFillers{
    "that",   "which",   "is",   "are",   "located", "placed",  "standing",
    "stands", "sitting", "sits", "lying", "lies",    "hanging", "situated"};
// Places within a room, no objects: "the picture on the left", "a chair in the corner".
constexpr std::array<std::string_view, 14> kPlaces{
    "left",   "right", "front",      "back",       "middle", "center", "centre",
    "corner", "room",  "background", "foreground", "side",   "top",    "bottom"};
constexpr std::array<std::string_view, 3> kPair{"two", "both", "2"};

constexpr std::size_t kMaxRelations = 16;  // in one query; more is no question but a text

bool is_one_of(std::string_view word, std::span<const std::string_view> list) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// Blank-separated; what stands between double quotes is one word with its quotes. A quote that
/// nothing closes is an inch mark: 24" monitor.
std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  std::string word;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') quoted = !quoted && text.find('"', i + 1) != std::string_view::npos;
    if (c == ' ' && !quoted) {
      if (!word.empty()) words.push_back(word);
      word.clear();
    } else {
      word += c;
    }
  }
  if (!word.empty()) words.push_back(word);
  return words;
}

std::string joined(Words words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

Words without_articles(Words words) {
  while (!words.empty() && is_one_of(lower(words[0]), kArticles)) words = words.subspan(1);
  return words;
}

Words without_fillers(Words words) {
  while (words.size() > 1 && is_one_of(lower(words.back()), kFillers))
    words = words.first(words.size() - 1);
  return words;
}

/// How many words of the front `phrase` takes up; 0 when they are others.
std::size_t match_length(Words words, std::string_view phrase) {
  std::size_t count = 0;
  while (!phrase.empty()) {
    const std::size_t end = std::min(phrase.find(' '), phrase.size());
    if (count == words.size() || lower(words[count]) != phrase.substr(0, end)) return 0;
    phrase.remove_prefix(std::min(end + 1, phrase.size()));
    ++count;
  }
  return count;
}

struct FoundRelation {
  Relation relation = Relation::kOn;
  std::size_t length = 0;  ///< words; 0: none here
};

FoundRelation relation_at(Words words) {
  FoundRelation found;
  for (const RelationWords& candidate : kRelations) {
    const std::size_t length = match_length(words, candidate.words);
    if (length > found.length) found = {candidate.relation, length};
  }
  return found;
}

std::optional<QueryPhrase> parse_words(Words words);

bool is_place(Words words) {
  words = without_articles(words);
  return words.size() == 1 && is_one_of(lower(words[0]), kPlaces);
}

/// `[superlative] things`, at least one thing.
std::optional<QueryPhrase> parse_things(Words words) {
  words = without_articles(words);
  QueryPhrase phrase;
  if (words.size() > 1)
    for (const SuperlativeWord& candidate : kSuperlatives)
      if (lower(words[0]) == candidate.word) phrase.superlative = candidate.superlative;
  if (phrase.superlative) words = without_articles(words.subspan(1));
  if (words.empty()) return std::nullopt;
  phrase.things = joined(words);
  phrase.anything = words.size() == 1 && is_one_of(lower(words[0]), kAnything);
  return phrase;
}

/// `A and B`, or `[the two] As`; empty when neither fits.
std::vector<QueryPhrase> parse_pair(Words words, bool& same_kind) {
  std::vector<QueryPhrase> anchors;
  for (std::size_t i = 1; i + 1 < words.size(); ++i) {
    if (lower(words[i]) != "and") continue;
    const auto first = parse_things(words.first(i));
    const auto second = parse_words(words.subspan(i + 1));
    if (first && second) return {*first, *second};
  }
  words = without_articles(words);
  if (!words.empty() && is_one_of(lower(words[0]), kPair)) words = words.subspan(1);
  const auto both = parse_words(words);
  if (!both) return {};
  same_kind = true;
  return {*both};
}

/// Reads the relation found at words[at], when there is something on both sides of it.
std::optional<QueryPhrase> parse_relation(Words words, std::size_t at, const FoundRelation& found) {
  Words left = words.first(at);
  const Words right = words.subspan(at + found.length);
  if (relation_at(right).length > 0) return std::nullopt;  // "television on on the wall"
  const bool negated = left.size() > 1 && lower(left.back()) == "not";
  if (negated) left = left.first(left.size() - 1);
  std::optional<QueryPhrase> phrase = parse_things(without_fillers(left));
  if (!phrase) return std::nullopt;
  phrase->relation = found.relation;
  phrase->negated = negated;
  if (found.relation == Relation::kBetween)
    phrase->anchors = parse_pair(right, phrase->same_kind);
  else if (is_place(right))
    return std::nullopt;
  else if (auto anchor = parse_words(right))
    phrase->anchors = {*std::move(anchor)};
  if (phrase->anchors.empty()) return std::nullopt;
  return phrase;
}

/// The leftmost relation that has something on both sides splits the words; what is right of it is
/// read the same way.
std::optional<QueryPhrase> parse_words(Words words) {
  for (std::size_t at = 1; at < words.size(); ++at) {
    const FoundRelation found = relation_at(words.subspan(at));
    if (found.length == 0) continue;
    if (auto phrase = parse_relation(words, at, found)) return phrase;
  }
  return parse_things(words);
}

const char* superlative_name(Superlative superlative) {
  for (const SuperlativeWord& candidate : kSuperlatives)
    if (candidate.superlative == superlative) return candidate.word.data();
  return "";
}

}  // namespace

QueryPhrase parse_query(std::string_view text) {
  const std::vector<std::string> words = words_of(text);
  std::size_t relations = 0;
  for (std::size_t at = 0; at < words.size(); ++at)
    relations += relation_at(Words(words).subspan(at)).length > 0;
  if (relations <= kMaxRelations) {
    const std::optional<QueryPhrase> phrase = parse_words(words);
    if (phrase && !phrase->free_text()) return *phrase;
  }
  // Free text goes to the encoder as it was written, articles included.
  QueryPhrase free;
  free.things = joined(words);
  return free;
}

std::string describe(const QueryPhrase& phrase) {
  std::string text;
  if (phrase.superlative) text += std::string(superlative_name(*phrase.superlative)) + " ";
  text += "[" + phrase.things + "]";
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
  }
  return "";
}

}  // namespace ovimap
