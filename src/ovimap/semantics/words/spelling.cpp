// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/spelling.h"

#include "ovimap/base/config.h"
#include "ovimap/base/edit_distance.h"
#include "ovimap/base/text/ascii.h"

namespace ovimap {

std::string meant_word(std::string_view text, const Concepts& concepts) {
  constexpr std::size_t kLettersAMistake = 4;
  if (!concepts.kinds_of(text).empty()) return {};
  const std::string word = lower_case(text.substr(text.find_last_of(' ') + 1));
  std::vector<std::string> known;
  for (const Concepts::HouseholdWord& household : concepts.household())
    known.push_back(household.word);
  const std::string nearest = nearest_word(word, known);
  return kLettersAMistake * edit_distance(word, nearest) <= word.size() ? nearest : std::string();
}

}  // namespace ovimap
