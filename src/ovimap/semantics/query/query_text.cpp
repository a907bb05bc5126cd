// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/query_text.h"

#include <algorithm>
#include <array>

#include "ovimap/base/error.h"
#include "ovimap/base/text/ascii.h"
#include "ovimap/semantics/words/text_evidence.h"
#include "ovimap/semantics/words/word_lists.h"

namespace ovimap {

namespace {

constexpr std::string_view kSlot = "{}";
constexpr std::string_view kBlanks = " \t\r\n\v\f";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string single_spaced(std::string_view text) {
  std::string result;
  for (const char c : trimmed(text)) {
    const bool blank = kBlanks.find(c) != std::string_view::npos;
    if (!blank)
      result += c;
    else if (result.back() != ' ')
      result += ' ';
  }
  return result;
}

/// "the red mug" -> "red mug", so that a template does not make it "a photo of a the red mug".
std::string_view without_article(std::string_view text) {
  for (const std::string_view article : {"a ", "an ", "the "})
    if (text.starts_with(article)) return text.substr(article.size());
  return text;
}

constexpr std::array<std::string_view, 10> kDeterminers{"a",    "an",  "the",  "all",   "every",
                                                        "each", "any", "some", "these", "those"};

/// "all the mugs" -> "mugs".
std::string_view without_determiners(std::string_view text) {
  while (true) {
    const std::size_t end = text.find(' ');
    const std::string first = lower_case(text.substr(0, end));
    if (end == std::string_view::npos ||
        std::find(kDeterminers.begin(), kDeterminers.end(), first) == kDeterminers.end())
      return text;
    text.remove_prefix(end + 1);
  }
}

std::ptrdiff_t characters(std::string_view utf8) {
  return std::count_if(utf8.begin(), utf8.end(), [](char c) { return (c & 0xC0) != 0x80; });
}

}  // namespace

std::vector<std::string> list_entries(std::string_view text) {
  std::vector<std::string> entries;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    if (!line.empty() && line.front() != '#') entries.emplace_back(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return entries;
}

std::string checked_query_text(std::string_view text, int max_chars) {
  std::string result = single_spaced(text);
  if (result.empty())
    throw Error("the query is empty; say what to look for, for instance \"chair\"");
  const std::ptrdiff_t length = characters(result);
  if (length > max_chars)
    throw Error(concat("the query has ", length, " characters, at most ", max_chars,
                       " are accepted; shorten it or set query.max_text_chars"));
  return result;
}

std::vector<std::string> split_terms(std::string_view text) {
  std::vector<std::string> terms;
  std::string term;
  bool quoted = false;
  const auto finish = [&] {
    if (std::string spaced = single_spaced(term); !spaced.empty()) terms.push_back(spaced);
    term.clear();
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool closed = quoted || text.find('"', i + 1) != std::string_view::npos;
    if (c == '"' && closed)
      quoted = !quoted;
    else if (c == ',' && !quoted)
      finish();
    else
      term += c;
  }
  finish();
  return terms;
}

std::string thing_of_term(const std::string& term) {
  return builtin_concepts().singular_of(without_determiners(term));
}

bool asks_for_all(const std::string& term) {
  const std::string_view words = without_determiners(term);
  const std::string asked = lower_case(term.substr(0, term.size() - words.size()));
  return asked.starts_with("all ") || asked.starts_with("every ") || asked.starts_with("each ") ||
         builtin_concepts().singular_of(words) != words;
}

std::vector<std::string> split_prompts(const std::string& templates) {
  std::vector<std::string> prompts;
  std::size_t begin = 0;
  while (begin <= templates.size()) {
    const std::size_t end = std::min(templates.find('|', begin), templates.size());
    prompts.push_back(templates.substr(begin, end - begin));
    if (prompts.back().find(kSlot) == std::string::npos)
      throw Error(concat("prompt template '", prompts.back(),
                         "' has no {}; write where the text goes, as in \"a photo of a {}\""));
    begin = end + 1;
  }
  return prompts;
}

Embeddings encode_prompted(ImageTextEncoder& encoder, std::span<const std::string> texts,
                           std::span<const std::string> templates, TextUse use) {
  std::vector<std::string> prompted;
  for (const std::string& text : texts)
    for (const std::string& prompt : templates) {
      const std::string_view words = prompt == kSlot ? text : without_article(text);
      prompted.push_back(std::string(prompt).replace(prompt.find(kSlot), kSlot.size(), words));
    }
  const Embeddings rows = use == TextUse::kVocabulary ? encoder.encode_vocabulary(prompted)
                                                      : encoder.encode_texts(prompted);
  const auto each = static_cast<Eigen::Index>(templates.size());
  Embeddings means(static_cast<Eigen::Index>(texts.size()), rows.cols());
  for (Eigen::Index i = 0; i < means.rows(); ++i)
    means.row(i) = rows.middleRows(i * each, each).colwise().mean().normalized();
  return means;
}

}  // namespace ovimap
