// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/query_grammar.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>

#include "ovimap/base/error.h"

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

struct SizeWord {
  std::string_view word;
  Side side;
  bool more;
};
constexpr std::array kSizeWords{
    SizeWord{"longer", Side::kLength, true},    SizeWord{"wider", Side::kLength, true},
    SizeWord{"narrower", Side::kLength, false}, SizeWord{"taller", Side::kHeight, true},
    SizeWord{"shorter", Side::kHeight, false},  SizeWord{"deeper", Side::kDepth, true},
    SizeWord{"thinner", Side::kDepth, false}};

struct UnitWord {
  std::string_view word;
  float metres;
};
constexpr std::array kUnits{
    UnitWord{"m", 1.f},         UnitWord{"metre", 1.f},    UnitWord{"metres", 1.f},
    UnitWord{"meter", 1.f},     UnitWord{"meters", 1.f},   UnitWord{"cm", 0.01f},
    UnitWord{"mm", 0.001f},     UnitWord{"inch", 0.0254f}, UnitWord{"inches", 0.0254f},
    UnitWord{"foot", 0.3048f},  UnitWord{"feet", 0.3048f}};

constexpr std::array<std::string_view, 9> kNumbers{"two",   "three", "four", "five", "six",
                                                   "seven", "eight", "nine", "ten"};
constexpr int kFirstNumber = 2, kMostCount = 1000;
constexpr std::array<std::string_view, 5> kShades{"dark", "light", "bright", "pale", "deep"};
// What may follow the thing in "how many chairs are there in the room".
constexpr std::array<std::string_view, 5> kCountFillers{"are", "is", "there", "here", "visible"};

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

std::optional<QueryPhrase> parse_words(Words words, bool colors);

bool is_place(Words words) {
  words = without_articles(words);
  return words.size() == 1 && is_one_of(lower(words[0]), kPlaces);
}

/// "two", "12"; 0 for other words.
int number_of(const std::string& word) {
  for (std::size_t i = 0; i < kNumbers.size(); ++i)
    if (lower(word) == kNumbers[i]) return kFirstNumber + static_cast<int>(i);
  const bool digits = !word.empty() && word.size() <= 4 &&
                      word.find_first_not_of("0123456789") == std::string::npos;
  const int number = digits ? std::atoi(word.c_str()) : 0;
  return number >= kFirstNumber && number <= kMostCount ? number : 0;
}

/// "1.5 m", "150cm", in metres.
std::optional<float> parse_length(Words words) {
  if (words.empty() || words.size() > 2) return std::nullopt;
  char* rest = nullptr;
  const float number = std::strtof(words[0].c_str(), &rest);
  const std::string unit = words.size() == 2 && *rest == 0 ? lower(words[1]) : lower(rest);
  if (rest == words[0].c_str() || !(number > 0.f) || (words.size() == 2 && *rest != 0))
    return std::nullopt;
  for (const UnitWord& known : kUnits)
    if (unit == known.word) return number * known.metres;
  return std::nullopt;
}

/// Takes "[that is] longer than 1.5 m" off the end.
std::optional<SizeBound> take_size(Words& words) {
  for (std::size_t at = 1; at + 2 < words.size(); ++at) {
    if (lower(words[at + 1]) != "than") continue;
    const std::optional<float> bound_m = parse_length(words.subspan(at + 2));
    for (const SizeWord& known : kSizeWords) {
      if (!bound_m || lower(words[at]) != known.word) continue;
      words = without_fillers(words.first(at));
      return SizeBound{known.side, known.more, *bound_m};
    }
  }
  return std::nullopt;
}

/// Takes "red" or "dark red" off the front, where one thing follows: of "red chair, sofa" only the
/// chair is red, which is left to the encoder.
std::optional<Color> take_color(Words& words) {
  for (const std::string& word : words)
    if (word.front() != '"' && word.find(',') != std::string::npos) return std::nullopt;
  const bool shaded = words.size() > 2 && is_one_of(lower(words[0]), kShades);
  const std::size_t at = shaded ? 1 : 0;
  if (at + 1 >= words.size()) return std::nullopt;
  const std::optional<Color> color = color_of_word(lower(words[at]));
  if (color) words = words.subspan(at + 1);
  return color;
}

/// "mugs" -> "mug", as good as it goes without a dictionary.
std::string singular(std::string word) {
  const auto ends = [&](std::string_view end) {
    return word.size() > end.size() + 1 && word.ends_with(end);
  };
  if (word.ends_with("shelves")) return word.substr(0, word.size() - 3) + "f";
  if (word.ends_with("knives")) return word.substr(0, word.size() - 3) + "fe";
  if (ends("ies")) return word.substr(0, word.size() - 3) + "y";
  if (ends("xes") || ends("ches") || ends("shes") || ends("sses"))
    return word.substr(0, word.size() - 2);
  if (ends("s") && !ends("ss")) return word.substr(0, word.size() - 1);
  return word;
}

std::string singular(Words words) {
  std::string text = joined(words.first(words.size() - 1));
  return text + (text.empty() ? "" : " ") + singular(words.back());
}

/// `[number] [superlative] [color] things [size]`, at least one thing.
std::optional<QueryPhrase> parse_things(Words words, bool colors) {
  words = without_articles(words);
  QueryPhrase phrase;
  if (words.size() > 1) phrase.count = number_of(words[0]);
  if (phrase.count > 0) words = without_articles(words.subspan(1));
  if (words.size() > 1)
    for (const SuperlativeWord& candidate : kSuperlatives)
      if (lower(words[0]) == candidate.word) phrase.superlative = candidate.superlative;
  if (phrase.superlative) words = without_articles(words.subspan(1));
  phrase.size = take_size(words);
  if (colors) phrase.color = take_color(words);
  if (words.empty()) return std::nullopt;
  phrase.things = phrase.count > 0 ? singular(words) : joined(words);
  phrase.anything = words.size() == 1 && is_one_of(lower(words[0]), kAnything);
  return phrase;
}

/// `A and B`, or `[the two] As`; empty when neither fits.
std::vector<QueryPhrase> parse_pair(Words words, bool colors, bool& same_kind) {
  std::vector<QueryPhrase> anchors;
  for (std::size_t i = 1; i + 1 < words.size(); ++i) {
    if (lower(words[i]) != "and") continue;
    const auto first = parse_things(words.first(i), colors);
    const auto second = parse_words(words.subspan(i + 1), colors);
    if (first && second) return {*first, *second};
  }
  words = without_articles(words);
  if (!words.empty() && is_one_of(lower(words[0]), kPair)) words = words.subspan(1);
  const auto both = parse_words(words, colors);
  if (!both) return {};
  same_kind = true;
  return {*both};
}

/// Reads the relation found at words[at], when there is something on both sides of it.
std::optional<QueryPhrase> parse_relation(Words words, std::size_t at, const FoundRelation& found,
                                          bool colors) {
  Words left = words.first(at);
  const Words right = words.subspan(at + found.length);
  if (relation_at(right).length > 0) return std::nullopt;  // "television on on the wall"
  const bool negated = left.size() > 1 && lower(left.back()) == "not";
  if (negated) left = left.first(left.size() - 1);
  std::optional<QueryPhrase> phrase = parse_things(without_fillers(left), colors);
  if (!phrase) return std::nullopt;
  phrase->relation = found.relation;
  phrase->negated = negated;
  if (found.relation == Relation::kBetween)
    phrase->anchors = parse_pair(right, colors, phrase->same_kind);
  else if (is_place(right))
    return std::nullopt;
  else if (auto anchor = parse_words(right, colors))
    phrase->anchors = {*std::move(anchor)};
  if (phrase->anchors.empty()) return std::nullopt;
  return phrase;
}

/// The leftmost relation that has something on both sides splits the words; what is right of it is
/// read the same way.
std::optional<QueryPhrase> parse_words(Words words, bool colors) {
  for (std::size_t at = 1; at < words.size(); ++at) {
    const FoundRelation found = relation_at(words.subspan(at));
    if (found.length == 0) continue;
    if (auto phrase = parse_relation(words, at, found, colors)) return phrase;
  }
  return parse_things(words, colors);
}

/// "how many chairs [are there] [relation anchor]".
std::optional<QueryPhrase> parse_how_many(Words words, bool colors) {
  if (match_length(words, "how many") == 0) return std::nullopt;
  words = words.subspan(2);
  while (words.size() > 1 && is_one_of(lower(words.back()), kCountFillers))
    words = words.first(words.size() - 1);
  std::vector<std::string> asked;  // "chairs are there on the rug": the fillers in the middle go
  for (const std::string& word : words)
    if (!is_one_of(lower(word), kCountFillers)) asked.push_back(word);
  std::optional<QueryPhrase> phrase = parse_words(asked, colors);
  if (!phrase) return std::nullopt;
  phrase->how_many = true;
  const std::vector<std::string> things = words_of(phrase->things);
  phrase->things = singular(Words(things));
  return phrase;
}

const char* superlative_name(Superlative superlative) {
  for (const SuperlativeWord& candidate : kSuperlatives)
    if (candidate.superlative == superlative) return candidate.word.data();
  return "";
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

QueryPhrase parse_query(std::string_view text, bool colors) {
  const std::vector<std::string> words = words_of(text);
  if (const auto counted = parse_how_many(words, colors)) return *counted;
  std::size_t relations = 0;
  for (std::size_t at = 0; at < words.size(); ++at)
    relations += relation_at(Words(words).subspan(at)).length > 0;
  if (relations <= kMaxRelations) {
    const std::optional<QueryPhrase> phrase = parse_words(words, colors);
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
  if (phrase.color) text += concat(color_name(*phrase.color), " ");
  text += "[" + phrase.things + "]";
  if (phrase.size)
    text += concat(phrase.size->more ? " more" : " less", " than ", phrase.size->bound_m, " m ",
                   side_name(phrase.size->side));
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
