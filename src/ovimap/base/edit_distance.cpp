// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/edit_distance.h"

#include <algorithm>
#include <numeric>

#include "ovimap/base/config.h"
#include "ovimap/base/text/ascii.h"

namespace ovimap {

namespace {

template <class Text>
std::size_t distance_between(Text a, Text b) {
  std::vector<std::size_t> last(b.size() + 1), row(b.size() + 1), next(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    next[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = row[j] + (a[i] == b[j] ? 0 : 1);
      next[j + 1] = std::min({replaced, row[j + 1] + 1, next[j] + 1});
      const bool swapped = i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j];
      if (swapped) next[j + 1] = std::min(next[j + 1], last[j - 1] + 1);
    }
    last.swap(row);
    row.swap(next);
  }
  return row.back();
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  return distance_between(a, b);
}

std::size_t edit_distance(std::u32string_view a, std::u32string_view b) {
  return distance_between(a, b);
}

std::string likely_word(std::string_view written, const std::vector<std::string>& candidates) {
  constexpr std::size_t kLettersAMistake = 4, kShortestStart = 3;
  const std::string word = lower_case(written);
  const std::string nearest = nearest_word(word, candidates);
  if (edit_distance(word, nearest) <= 1 + word.size() / kLettersAMistake) return nearest;
  const auto begun =
      std::find_if(candidates.begin(), candidates.end(), [&](const std::string& candidate) {
        return word.size() >= kShortestStart && candidate.starts_with(word);
      });
  return begun == candidates.end() ? std::string() : *begun;
}

}  // namespace ovimap
