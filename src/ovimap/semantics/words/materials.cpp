// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/materials.h"

#include <algorithm>
#include <array>
#include <span>
#include <sstream>

#include "ovimap/base/text/ascii.h"
#include "ovimap/semantics/words/one_of.h"

namespace ovimap {

namespace {

// "Paper" is left out: a paper bin is for paper.
constexpr std::array<std::string_view, 40> kMaterialWords{
    "wood",     "wooden",    "oak",     "pine",      "beech",    "walnut",    "metal",
    "metallic", "steel",     "iron",    "aluminium", "aluminum", "chrome",    "brass",
    "copper",   "glass",     "plastic", "rubber",    "ceramic",  "porcelain", "clay",
    "stone",    "marble",    "granite", "concrete",  "leather",  "cloth",     "fabric",
    "woollen",  "velvet",    "wicker",  "rattan",    "bamboo",   "cardboard", "striped",
    "checked",  "checkered", "dotted",  "spotted",   "patterned"};

constexpr std::array<std::string_view, 6> kAfterThing{"of", "with", "without", "for", "full", "to"};

}  // namespace

std::vector<std::string> material_words(std::string_view text, const Concepts& concepts) {
  std::vector<std::string> words, materials;
  std::istringstream parts{std::string(text)};
  for (std::string word; parts >> word;) words.push_back(word);
  // From the front on: of "old wooden table" it is "wooden", of "wooden spoon" nothing.
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::string from_here;
    for (std::size_t k = i; k < words.size(); ++k) from_here += (k > i ? " " : "") + words[k];
    const bool named = i + 1 == words.size() || is_one_of(lower_case(words[i + 1]), kAfterThing) ||
                       concepts.knows(from_here);
    if (named) break;
    if (const std::string word = lower_case(words[i]); is_one_of(word, kMaterialWords))
      materials.push_back(word);
  }
  return materials;
}

}  // namespace ovimap
