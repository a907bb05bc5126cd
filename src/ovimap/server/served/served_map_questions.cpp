// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// What clients ask of a served map.
#include "ovimap/map/surface/surface_precision.h"
#include "ovimap/semantics/classes/name_search.h"
#include "ovimap/semantics/query/query_text.h"
#include "ovimap/server/served/served_map.h"

namespace ovimap {

namespace {

/// Names that people gave need no encoder.
QueryAnswer answer_by_name(const MapSnapshot& now, const MapQuestion& question) {
  QueryAnswer answer;
  if (!question.like) answer = find_by_name(now.index(), question.query);
  if (answer.matches.empty()) throw SearchUnavailable(now.why_no_search);
  return answer;
}

}  // namespace

MapAnswer ServedMap::ask(const MapQuestion& question) const {
  std::shared_ptr<const MapSnapshot> now = prepared_snapshot();
  if (question.past) return ask_past(std::move(now), question);
  if (!now->engine) return {answer_by_name(*now, question), now};
  const bool relevance = question.query.relevance;
  return {question.like ? now->engine->find_like(*question.like, relevance)
                        : now->engine->find(question.query),
          now};
}

std::optional<HistoryPhrase> ServedMap::past_of(const std::string& text, const std::string& at,
                                                const std::string& since) const {
  const bool timed = !at.empty() || !since.empty();
  if (!text.empty() || !timed) checked_query_text(text, config_.query.max_text_chars);
  if (!config_.query.grammar && !timed) return std::nullopt;
  return history_of_question(text, at, since, seconds_now());
}

/// What changed can be told of any map; what a text means needs its encoder.
MapAnswer ServedMap::ask_past(std::shared_ptr<const MapSnapshot> now,
                              const MapQuestion& question) const {
  const auto found = std::make_shared<HistorySearch>(
      search_history(*now->record, now->objects->info, *question.past));
  found->search.scene.taught = now->objects->scene.taught;
  const std::shared_ptr<const HistorySearch> past = found;
  const bool listing = past->for_anything() && question.query.not_texts.empty();
  if (!now->engine && !listing) throw SearchUnavailable(now->why_no_search);
  std::optional<QueryEngine> engine;
  if (!listing)
    engine.emplace(past->search.index, encoder_.get(), config_.query, Embeddings{},
                   past->search.scene);
  QueryAnswer answer = ask_history(*past, engine ? &*engine : nullptr, question.query);
  answer.query = question.query.text;
  return {std::move(answer), std::move(now), past};
}

WordsOfObjects ServedMap::words_with_gone(const MapSnapshot& now) const {
  if (!now.engine) return {};
  const std::lock_guard lock(words_mutex_);
  if (words_version_ != now.version)
    words_ = ovimap::words_with_gone(*now.record, now.objects->info, *encoder_, config_.query,
                                     now.objects->scene.taught);
  words_version_ = now.version;
  return words_;
}

std::vector<Gap> ServedMap::gaps(const GapsConfig& config) const {
  const auto surface = this->surface();
  SurfaceErrors errors;
  for (const auto& [block, error] : surface->errors()) errors[block] = error_of_byte(error);
  return find_gaps(snapshot()->record->seen_free, errors, surface->grid().block_m(), config);
}

}  // namespace ovimap
