// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ovimap/semantics/query/query_grammar.h"

namespace ovimap {

using Words = std::span<const std::string>;

/// Blank-separated; what stands between double quotes is one word with its quotes. A quote that
/// nothing closes is an inch mark: 24" monitor.
std::vector<std::string> words_of(std::string_view text);
std::string joined(Words words);

/// What words mean to the grammar, in any case of letters.
enum class WordRole { kArticle, kAnything, kFiller, kPair, kStrength, kCountFiller };
bool plays(const std::string& word, WordRole role);

Words without_articles(Words words);
/// "the mug that is standing" -> "the mug"; one word stays.
Words without_fillers(Words words);

/// How many words of the front `phrase` takes up; 0 when they are others.
std::size_t match_length(Words words, std::string_view phrase);

struct FoundRelation {
  Relation relation = Relation::kOn;
  std::size_t length = 0;  ///< words; 0: none here
};

/// The longest relation that the words begin with.
FoundRelation relation_at(Words words);

/// Places within a room, no objects: "on the left", "in the corner".
bool is_place(Words words);

std::optional<Superlative> superlative_of(const std::string& word);
const char* superlative_name(Superlative superlative);

/// "two", "12"; 0 for other words.
int number_of(const std::string& word);

/// Takes "[that is] longer than 1.5 m" off the end.
std::optional<SizeBound> take_size(Words& words);

/// Takes text:"WRITING" or text:WRITING off the end or the front; what is written, or nothing.
std::string take_writing(Words& words);

/// With its last word in the singular, as good as it goes without a dictionary.
std::string singular(Words words);

}  // namespace ovimap
