// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/classes/name_search.h"

#include <algorithm>
#include <tuple>

#include "ovimap/base/text/ascii.h"
#include "ovimap/semantics/query/query_text.h"

namespace ovimap {

namespace {

/// Whether all of `words` stands in `name`, with blanks or nothing around it.
bool holds_words(const std::string& name, const std::string& words) {
  return !words.empty() &&
         (" " + lower_case(name) + " ").find(" " + words + " ") != std::string::npos;
}

bool holds_any(const std::string& name, const std::vector<std::string>& texts) {
  return std::any_of(texts.begin(), texts.end(),
                     [&](const std::string& text) { return holds_words(name, lower_case(text)); });
}

}  // namespace

QueryAnswer find_by_name(const SearchIndex& index, const Query& query) {
  QueryAnswer answer;
  answer.query = query.text;
  const std::vector<std::string> terms = split_terms(query.text);
  for (std::size_t i = 0; i < index.size(); ++i) {
    const SearchObject& object = index.object(i);
    const bool may_be = query.among.empty() || query.among[i];
    if (!may_be || !holds_any(object.name, terms) || holds_any(object.name, query.not_texts))
      continue;
    QueryMatch& match = answer.matches.emplace_back();
    match.position = i;
    match.id = object.id;
    match.probability = 1;
    match.evidence = "called so";
  }
  std::ranges::sort(answer.matches, {}, [&](const QueryMatch& match) {
    return std::tuple(index.object(match.position).name.size(), match.id);
  });
  if (!answer.matches.empty()) answer.verdict = Verdict::kFound;
  if (!query.relevance) return answer;
  answer.relevance.setZero(static_cast<Eigen::Index>(index.size()));
  for (const QueryMatch& match : answer.matches)
    answer.relevance[static_cast<Eigen::Index>(match.position)] = 1.f;
  return answer;
}

}  // namespace ovimap
