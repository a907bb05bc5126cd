// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace ovimap {

/// "mugs" -> "mug", as good as it goes without a dictionary.
std::string singular(std::string word);

/// Which words name a kind of which thing: a mug is a drinking vessel, a container, an artefact.
/// A part of WordNet (docs/NOTICE-wordnet.md). Immutable.
class Concepts {
 public:
  using Kind = std::size_t;

  /// Lines "words;parents": words separated by |, a household word first with an asterisk, and the
  /// numbers of lines before this one, from 0, separated by blanks. Throws Error for other lines.
  explicit Concepts(const std::vector<std::string>& lines);

  /// The kinds that a text may mean: those of the whole text, else of its longest end that is known
  /// ("wooden kitchen chair": chair), before "of", "with" and the like ("bottle of milk": bottle).
  /// Empty where nothing is known.
  std::vector<Kind> kinds_of(std::string_view text) const;

  /// The same, but of a household word its household sense alone: a stool to sit on, no toilet.
  std::vector<Kind> senses_of(std::string_view text) const;

  /// The text with its last word in the singular, where that is a word of it and the plural is none
  /// of its own: "kitchen chairs" -> "kitchen chair", but "glasses". Else the text.
  std::string singular_of(std::string_view text) const;

  /// Whether the whole text is a word of it, in the singular or the plural.
  bool knows(std::string_view text) const;

  bool is_kind_of(Kind kind, Kind of) const;

  /// Whether one thing can be both: one of them is a kind of the other, in some sense of the texts.
  bool compatible(const std::vector<Kind>& a, const std::vector<Kind>& b) const;

  struct HouseholdWord {
    std::string word;
    Kind kind;
  };
  const std::vector<HouseholdWord>& household() const { return household_; }

 private:
  enum class Senses { kAll, kHousehold };
  std::vector<Kind> find(std::string_view text, Senses senses) const;
  std::vector<Kind> exact(const std::string& words, Senses senses) const;
  std::vector<Kind> known(const std::string& words, Senses senses) const;

  std::vector<std::vector<Kind>> above_;  ///< of each kind, ascending, itself included
  std::unordered_map<std::string, std::vector<Kind>> by_word_;
  std::vector<HouseholdWord> household_;
  std::unordered_map<std::string, Kind> household_sense_;
};

}  // namespace ovimap
