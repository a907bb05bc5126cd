// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/query_words.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "ovimap/base/text/ascii.h"
#include "ovimap/semantics/words/concepts.h"
#include "ovimap/semantics/words/one_of.h"

namespace ovimap {

namespace {

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
    // A bottle of milk and a cup of tea are things, a drawer of the cabinet is a part of one.
    RelationWords{"of the", Relation::kPartOf},
    RelationWords{"of this", Relation::kPartOf},
    RelationWords{"of that", Relation::kPartOf},
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
constexpr std::array kLengthUnits{
    UnitWord{"m", 1.f},        UnitWord{"metre", 1.f},    UnitWord{"metres", 1.f},
    UnitWord{"meter", 1.f},    UnitWord{"meters", 1.f},   UnitWord{"cm", 0.01f},
    UnitWord{"mm", 0.001f},    UnitWord{"inch", 0.0254f}, UnitWord{"inches", 0.0254f},
    UnitWord{"foot", 0.3048f}, UnitWord{"feet", 0.3048f}};

constexpr std::array<std::string_view, 9> kNumbers{"two",   "three", "four", "five", "six",
                                                   "seven", "eight", "nine", "ten"};
constexpr int kFirstNumber = 2, kMostCount = 1000;
// Before a colour, beside its shades: how strong or how light it is.
constexpr std::array<std::string_view, 1> kStrengths{"bright"};
// What may follow the thing in "how many chairs are there in the room".
constexpr std::array<std::string_view, 5> kCountFillers{"are", "is", "there", "here", "visible"};

/// "1.5 m", "150cm", in metres.
std::optional<float> parse_length(Words words) {
  if (words.empty() || words.size() > 2) return std::nullopt;
  char* rest = nullptr;
  const float number = std::strtof(words[0].c_str(), &rest);
  const std::string unit =
      words.size() == 2 && *rest == 0 ? lower_case(words[1]) : lower_case(rest);
  if (rest == words[0].c_str() || !(number > 0.f) || (words.size() == 2 && *rest != 0))
    return std::nullopt;
  for (const UnitWord& known : kLengthUnits)
    if (unit == known.word) return number * known.metres;
  return std::nullopt;
}

}  // namespace

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

bool plays(const std::string& word, WordRole role) {
  const std::string lower = lower_case(word);
  switch (role) {
    case WordRole::kArticle:
      return is_one_of(lower, kArticles);
    case WordRole::kAnything:
      return is_one_of(lower, kAnything);
    case WordRole::kFiller:
      return is_one_of(lower, kFillers);
    case WordRole::kPair:
      return is_one_of(lower, kPair);
    case WordRole::kStrength:
      return is_one_of(lower, kStrengths);
    case WordRole::kCountFiller:
      return is_one_of(lower, kCountFillers);
  }
  return false;
}

std::string joined(Words words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

Words without_articles(Words words) {
  while (!words.empty() && plays(words[0], WordRole::kArticle)) words = words.subspan(1);
  return words;
}

Words without_fillers(Words words) {
  while (words.size() > 1 && plays(words.back(), WordRole::kFiller))
    words = words.first(words.size() - 1);
  return words;
}

std::size_t match_length(Words words, std::string_view phrase) {
  std::size_t count = 0;
  while (!phrase.empty()) {
    const std::size_t end = std::min(phrase.find(' '), phrase.size());
    if (count == words.size() || lower_case(words[count]) != phrase.substr(0, end)) return 0;
    phrase.remove_prefix(std::min(end + 1, phrase.size()));
    ++count;
  }
  return count;
}

FoundRelation relation_at(Words words) {
  FoundRelation found;
  for (const RelationWords& candidate : kRelations) {
    const std::size_t length = match_length(words, candidate.words);
    if (length > found.length) found = {candidate.relation, length};
  }
  return found;
}

bool is_place(Words words) {
  words = without_articles(words);
  return words.size() == 1 && is_one_of(lower_case(words[0]), kPlaces);
}

std::optional<Superlative> superlative_of(const std::string& word) {
  for (const SuperlativeWord& candidate : kSuperlatives)
    if (lower_case(word) == candidate.word) return candidate.superlative;
  return std::nullopt;
}

const char* superlative_name(Superlative superlative) {
  for (const SuperlativeWord& candidate : kSuperlatives)
    if (candidate.superlative == superlative) return candidate.word.data();
  return "";
}

int number_of(const std::string& word) {
  for (std::size_t i = 0; i < kNumbers.size(); ++i)
    if (lower_case(word) == kNumbers[i]) return kFirstNumber + static_cast<int>(i);
  const bool digits = !word.empty() && word.size() <= 4 &&
                      word.find_first_not_of("0123456789") == std::string::npos;
  const int number = digits ? std::atoi(word.c_str()) : 0;
  return number >= kFirstNumber && number <= kMostCount ? number : 0;
}

std::optional<SizeBound> take_size(Words& words) {
  for (std::size_t at = 1; at + 2 < words.size(); ++at) {
    if (lower_case(words[at + 1]) != "than") continue;
    const std::optional<float> bound_m = parse_length(words.subspan(at + 2));
    for (const SizeWord& known : kSizeWords) {
      if (!bound_m || lower_case(words[at]) != known.word) continue;
      words = without_fillers(words.first(at));
      return SizeBound{known.side, known.more, *bound_m};
    }
  }
  return std::nullopt;
}

std::string take_writing(Words& words) {
  constexpr std::string_view kMark = "text:";
  const auto marked = [&](const std::string& word) {
    return word.size() > kMark.size() && lower_case(word).starts_with(kMark);
  };
  if (words.empty() || !(marked(words.back()) || marked(words.front()))) return {};
  const bool last = marked(words.back());
  std::string writing = (last ? words.back() : words.front()).substr(kMark.size());
  std::erase(writing, '"');
  words = last ? without_fillers(words.first(words.size() - 1)) : words.subspan(1);
  return writing;
}

std::string singular(Words words) {
  std::string text = joined(words.first(words.size() - 1));
  return text + (text.empty() ? "" : " ") + singular(words.back());
}

}  // namespace ovimap
