// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/concepts.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "ovimap/base/error.h"
#include "ovimap/base/text/ascii.h"

namespace ovimap {

namespace {

/// What follows tells more of a thing that is named before it.
constexpr std::array kBeforeDetails = {" of ", " with ", " for ", " from ", " to ", " without "};

std::vector<std::string> parts_of(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);)
    if (!part.empty()) parts.push_back(part);
  return parts;
}

}  // namespace

Concepts::Concepts(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    const Kind kind = above_.size();
    const std::size_t end = line.find(';');
    if (end == std::string::npos) throw Error(concat("'", line, "' is no line of words;parents"));
    std::vector<Kind> above{kind};
    for (const std::string& number : parts_of(line.substr(end + 1), ' ')) {
      const std::size_t parent = std::stoul(number);
      if (parent >= kind) throw Error(concat("'", line, "' comes before its parent ", parent));
      above.insert(above.end(), above_[parent].begin(), above_[parent].end());
    }
    std::sort(above.begin(), above.end());
    above.erase(std::unique(above.begin(), above.end()), above.end());
    above_.push_back(std::move(above));
    for (std::string word : parts_of(line.substr(0, end), '|')) {
      if (word[0] == '*') {
        word.erase(0, 1);
        household_.push_back({word, kind});
        household_sense_.emplace(word, kind);
      }
      by_word_[word].push_back(kind);
    }
  }
}

std::vector<Concepts::Kind> Concepts::exact(const std::string& words, Senses senses) const {
  if (senses == Senses::kHousehold)
    if (const auto sense = household_sense_.find(words); sense != household_sense_.end())
      return {sense->second};
  const auto found = by_word_.find(words);
  return found == by_word_.end() ? std::vector<Kind>{} : found->second;
}

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

std::string Concepts::singular_of(std::string_view text) const {
  const std::string words = lower_case(text);
  if (!exact(words, Senses::kAll).empty()) return std::string(text);
  const std::size_t blank = words.rfind(' '), last = blank == std::string::npos ? 0 : blank + 1;
  const std::string plural = words.substr(last);
  if (!plural.ends_with('s') || !exact(plural, Senses::kAll).empty()) return std::string(text);
  // "cookies" is of "cookie" where that is a word, else of "cooky".
  for (const std::string& one : {plural.substr(0, plural.size() - 1), singular(plural)})
    if (one != plural && (!exact(one, Senses::kAll).empty() ||
                          !exact(words.substr(0, last) + one, Senses::kAll).empty()))
      return std::string(text.substr(0, last)) + one;
  return std::string(text);
}

std::vector<Concepts::Kind> Concepts::known(const std::string& words, Senses senses) const {
  std::vector<Kind> kinds = exact(words, senses);
  for (const std::string_view plural : {"s", "es"})
    if (kinds.empty() && words.size() > plural.size() + 1 && words.ends_with(plural))
      kinds = exact(words.substr(0, words.size() - plural.size()), senses);
  return kinds;
}

std::vector<Concepts::Kind> Concepts::kinds_of(std::string_view text) const {
  return find(text, Senses::kAll);
}

std::vector<Concepts::Kind> Concepts::senses_of(std::string_view text) const {
  return find(text, Senses::kHousehold);
}

bool Concepts::knows(std::string_view text) const {
  return !known(lower_case(text), Senses::kAll).empty();
}

std::vector<Concepts::Kind> Concepts::find(std::string_view text, Senses senses) const {
  std::string words = lower_case(text);
  if (auto whole = known(words, senses); !whole.empty()) return whole;
  for (const std::string_view separator : kBeforeDetails)
    if (const std::size_t at = words.find(separator); at != std::string::npos) words.resize(at);
  while (!words.empty()) {
    if (auto kinds = known(words, senses); !kinds.empty()) return kinds;
    const std::size_t blank = words.find(' ');
    if (blank == std::string::npos) break;
    words.erase(0, blank + 1);
  }
  return {};
}

bool Concepts::is_kind_of(Kind kind, Kind of) const {
  return std::binary_search(above_[kind].begin(), above_[kind].end(), of);
}

bool Concepts::compatible(const std::vector<Kind>& a, const std::vector<Kind>& b) const {
  for (const Kind one : a)
    for (const Kind other : b)
      if (is_kind_of(one, other) || is_kind_of(other, one)) return true;
  return false;
}

}  // namespace ovimap
