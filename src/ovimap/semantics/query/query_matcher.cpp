// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/query_matcher.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/error.h"
#include "ovimap/semantics/query/query_text.h"
#include "ovimap/semantics/query/word_lists.h"

namespace ovimap {

namespace {

std::vector<std::string> prompts_of(const ImageTextEncoder& encoder, const QueryConfig& config) {
  return split_prompts(config.prompts.empty() ? encoder.prompt_template() : config.prompts);
}

/// Takes over the object's scores where `other` is better (any) or worse (all).
void join(MatchScores& scores, const MatchScores& other, TermRule rule) {
  for (Eigen::Index i = 0; i < scores.standard.size(); ++i) {
    const bool better = other.standard[i] > scores.standard[i];
    if (better != (rule == TermRule::kAny)) continue;
    scores.standard[i] = other.standard[i];
    scores.cosines[i] = other.cosines[i];
  }
}

}  // namespace

void require_embeddings(const SearchIndex& index) {
  if (index.size() == 0)
    throw Error("the map holds no object to be found; map the recording again with more frames");
  if (index.embedded() == 0)
    throw Error(concat("none of the map's ", index.size(),
                       " objects has an embedding; map with an encoder (--encoder), or run "
                       "`ovimap reembed` on it"));
}

void require_embedding_length(const SearchIndex& index, Eigen::Index length,
                              const std::string& whose) {
  if (length == index.dimension()) return;
  throw Error(concat("the map's embeddings have ", index.dimension(), " numbers, those of ", whose,
                     " have ", length,
                     "; name the encoder that the map was made with, or run `ovimap reembed`"));
}

TextMatcher::TextMatcher(const SearchIndex& index, ImageTextEncoder& encoder,
                         const QueryConfig& config, Embeddings vocabulary)
    : index_(index),
      encoder_(encoder),
      config_(config),
      prompts_(prompts_of(encoder, config)),
      vocabulary_(std::move(vocabulary)) {
  require_embeddings(index);
  require_embedding_length(index, encoder.identity().dimension,
                           "encoder '" + encoder.identity().name + "'");
  if (vocabulary_.rows() == 0) vocabulary_ = encode_vocabulary(encoder, config_);
  require_embedding_length(index, vocabulary_.cols(), "the vocabulary");
  if (vocabulary_.rows() < config.verdict.min_references)
    throw Error(concat("verdict.min_references is ", config.verdict.min_references,
                       ", but the vocabulary has ", vocabulary_.rows(),
                       " words; give at most so many"));
  calibration_.emplace(index, vocabulary_, config.verdict);
}

std::vector<std::string> TextMatcher::vocabulary_texts() {
  return list_entries(builtin_word_list("vocabulary"));
}

Embeddings TextMatcher::encode_vocabulary(ImageTextEncoder& encoder, const QueryConfig& config) {
  return encode_prompted(encoder, vocabulary_texts(), prompts_of(encoder, config));
}

MatchScores TextMatcher::match(const std::vector<std::string>& terms,
                               const std::vector<std::string>& negatives) const {
  OVIMAP_ASSERT(!terms.empty());
  std::vector<std::string> texts = terms;
  texts.insert(texts.end(), negatives.begin(), negatives.end());
  const Embeddings rows = encode_prompted(encoder_, texts, prompts_);
  for (std::size_t i = 0; i < texts.size(); ++i)
    if (rows.row(static_cast<Eigen::Index>(i)).isZero(0.f))
      throw Error(concat("encoder '", encoder_.identity().name, "' gave no embedding of '",
                         texts[i], "'; try other words"));
  const auto count = static_cast<Eigen::Index>(terms.size());
  MatchScores scores = joined(rows, 0, count, config_.terms);
  if (!negatives.empty())
    apply_negatives(joined(rows, count, rows.rows() - count, TermRule::kAny), scores);
  return scores;
}

MatchScores TextMatcher::joined(const Embeddings& rows, Eigen::Index first, Eigen::Index count,
                                TermRule rule) const {
  MatchScores scores;
  for (Eigen::Index row = first; row < first + count; ++row) {
    MatchScores term;
    term.cosines = index_.cosines(rows.row(row).transpose());
    term.standard = calibration_->standard_scores(term.cosines);
    if (row == first)
      scores = std::move(term);
    else
      join(scores, term, rule);
  }
  scores.excluded.assign(index_.size(), false);
  scores.alternatives = rule == TermRule::kAny ? static_cast<int>(count) : 1;
  return scores;
}

void TextMatcher::apply_negatives(const MatchScores& negative, MatchScores& scores) const {
  for (Eigen::Index i = 0; i < scores.standard.size(); ++i) {
    const float excess = negative.standard[i] - scores.standard[i];
    if (excess <= 0.f) continue;
    if (config_.negatives == NegativeRule::kExclude)
      scores.excluded[static_cast<std::size_t>(i)] = true;
    else
      scores.standard[i] -= excess;
  }
}

double TextMatcher::p_value(const MatchScores& scores, float standard_score) const {
  // The best of several terms has several chances to score high (Sidak 1967).
  const double single = calibration_->null_distribution().p_value(double{standard_score});
  return -std::expm1(scores.alternatives * std::log1p(-single));
}

float TextMatcher::score_at(const MatchScores& scores, double p) const {
  const double single = -std::expm1(std::log1p(-p) / scores.alternatives);
  return static_cast<float>(calibration_->null_distribution().score_at(single));
}

}  // namespace ovimap
