// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/written_words.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "ovimap/base/edit_distance.h"
#include "ovimap/inference/text/unicode.h"

namespace ovimap {

namespace {

constexpr float kLeastLikeness = 0.75f;

bool is_word_part(char32_t c) {
  return is_letter(c) || is_number(c) || is_nonspacing_mark(c) || c == U'+' || c == U'#' ||
         c == U'&';
}

float likeness(std::u32string_view wanted, std::u32string_view read) {
  if (wanted == read) return 1.f;
  const auto longest = static_cast<float>(std::max(wanted.size(), read.size()));
  const auto shortest = static_cast<float>(std::min(wanted.size(), read.size()));
  if (shortest < kLeastLikeness * longest) return 0.f;
  const float alike = 1.f - static_cast<float>(edit_distance(wanted, read)) / longest;
  return alike >= kLeastLikeness ? alike : 0.f;
}

}  // namespace

std::vector<WrittenLine> surest_readings(std::vector<WrittenLine> lines) {
  std::stable_sort(lines.begin(), lines.end(), [](const WrittenLine& a, const WrittenLine& b) {
    return a.confidence > b.confidence;
  });
  std::map<std::u32string, int> readings;
  std::erase_if(lines, [&](const WrittenLine& line) {
    return readings[lowered(decode_utf8(line.text))]++ > 0;
  });
  return lines;
}

std::vector<WrittenLine> writing_of(const Appearance& appearance) {
  std::vector<WrittenLine> lines;
  for (const ObjectView* view : appearance.views)
    lines.insert(lines.end(), view->writing.begin(), view->writing.end());
  return surest_readings(std::move(lines));
}

std::vector<std::u32string> written_words(std::string_view text) {
  std::vector<std::u32string> words(1);
  for (const char32_t c : lowered(decode_utf8(text))) {
    if (is_word_part(c))
      words.back() += c;
    else if (!words.back().empty())
      words.emplace_back();
  }
  std::erase_if(words, [](const std::u32string& word) { return word.empty(); });
  const auto is_article = [](const std::u32string& word) {
    return word == U"a" || word == U"an" || word == U"the";
  };
  if (!std::all_of(words.begin(), words.end(), is_article)) std::erase_if(words, is_article);
  return words;
}

WritingMatch match_writing(std::span<const std::u32string> wanted,
                           std::span<const WrittenLine> lines) {
  WritingMatch match;
  std::vector<float> best(wanted.size(), 0.f);
  float surest = 0.f;
  for (const WrittenLine& line : lines)
    for (const std::u32string& read : written_words(line.text))
      for (std::size_t i = 0; i < wanted.size(); ++i) {
        const float strength = line.confidence * likeness(wanted[i], read);
        best[i] = std::max(best[i], strength);
        if (strength <= surest) continue;
        surest = strength;
        match.line = &line;
      }
  if (!wanted.empty())
    match.share =
        std::accumulate(best.begin(), best.end(), 0.f) / static_cast<float>(wanted.size());
  return match;
}

}  // namespace ovimap
