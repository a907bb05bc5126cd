// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/query_matcher.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"
#include "ovimap/semantics/query/query_text.h"
#include "ovimap/semantics/words/word_lists.h"

namespace ovimap {

namespace {

constexpr std::size_t kMostTexts = 64;  // of one question: each is encoded, and held against all

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
    if (scores.log_odds.size() > 0) scores.log_odds[i] = other.log_odds[i];
  }
}

/// What people named in this map and in others.
TaughtNames names_for(const SearchIndex& index, const TaughtThings& elsewhere) {
  TaughtThings own{{}, index.embeddings()};
  for (const SearchObject& object : index.objects()) own.names.push_back(object.name);
  return {builtin_concepts(), own, elsewhere};
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
                         const QueryConfig& config, Embeddings vocabulary,
                         std::span<const ObjectMeasures> measures,
                         std::span<const std::vector<WrittenLine>> writing,
                         const SeenThings& things, const TaughtThings& taught)
    : index_(index),
      encoder_(encoder),
      config_(config),
      prompts_(prompts_of(encoder, config)),
      writing_(writing.begin(), writing.end()),
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
  null_ = calibration_->null_distribution();
  if (index.size() <= static_cast<std::size_t>(config.evidence.max_objects))
    weigh_evidence(measures, things, taught);
}

void TextMatcher::weigh_evidence(std::span<const ObjectMeasures> measures, const SeenThings& things,
                                 const TaughtThings& taught) {
  evidence_.emplace(
      measures, things, names_for(index_, taught), encode_word_lists(encoder_, config_),
      [&](const Eigen::VectorXf& row) {
        return calibration_->standard_scores(index_.cosines(row));
      },
      config_.evidence);
  // What absent things reach, with all evidence.
  const std::vector<std::string> words = vocabulary_texts();
  std::vector<double> best(static_cast<std::size_t>(vocabulary_.rows()),
                           std::numeric_limits<double>::lowest());
  parallel_for(best.size(), 1, [&](std::size_t word) {
    const Eigen::VectorXf row = vocabulary_.row(static_cast<Eigen::Index>(word)).transpose();
    // A vocabulary that was handed in need not be of these words.
    const MatchScores scores = scores_of(word < words.size() ? words[word] : "", row);
    for (std::size_t i = 0; i < index_.size(); ++i)
      if (index_.has_embedding(i))
        best[word] = std::max(best[word], double{scores.standard[static_cast<Eigen::Index>(i)]});
  });
  null_ = fit_null(std::move(best), null_.likeness, config_.verdict);
}

MatchScores TextMatcher::scores_of(const std::string& text, const Eigen::VectorXf& row) const {
  MatchScores scores;
  scores.cosines = index_.cosines(row);
  scores.standard = calibration_->standard_scores(scores.cosines);
  if (!evidence_) return scores;
  TextScores weighed = evidence_->weigh(text, row, scores.standard);
  scores.standard = std::move(weighed.standard);
  scores.log_odds = std::move(weighed.log_odds);
  add_writing(text, scores);
  return scores;
}

/// What says "Dedalus" on it is the Dedalus box, whatever it looks like.
void TextMatcher::add_writing(const std::string& text, MatchScores& scores) const {
  const std::vector<std::u32string> words = written_words(text);
  for (std::size_t i = 0; i < writing_.size(); ++i) {
    if (writing_[i].empty()) continue;
    const float said = config_.evidence.writing_weight * match_writing(words, writing_[i]).share;
    scores.standard[static_cast<Eigen::Index>(i)] += said;
    scores.log_odds[static_cast<Eigen::Index>(i)] += said;
  }
}

std::vector<std::string> TextMatcher::vocabulary_texts() {
  return list_entries(builtin_word_list("vocabulary"));
}

Embeddings TextMatcher::encode_vocabulary(ImageTextEncoder& encoder, const QueryConfig& config) {
  return encode_prompted(encoder, vocabulary_texts(), prompts_of(encoder, config),
                         TextUse::kVocabulary);
}

WordLists TextMatcher::encode_word_lists(ImageTextEncoder& encoder, const QueryConfig& config) {
  WordLists lists;
  lists.texts = TextEvidence::texts();
  lists.rows =
      encode_prompted(encoder, lists.texts, prompts_of(encoder, config), TextUse::kVocabulary);
  return lists;
}

MatchScores TextMatcher::match(const std::vector<std::string>& terms,
                               const std::vector<std::string>& negatives) const {
  OVIMAP_ASSERT(!terms.empty());
  std::vector<std::string> texts;
  for (const std::vector<std::string>* asked : {&terms, &negatives})
    for (const std::string& term : *asked)
      texts.push_back(index_.is_name(term) ? term : thing_of_term(term));
  if (texts.size() > kMostTexts)
    throw Error(concat("a question of ", texts.size(), " things is too long; ask for at most ",
                       kMostTexts, " at once, what it must not be included"));
  const Embeddings rows = encode_prompted(encoder_, texts, prompts_);
  for (std::size_t i = 0; i < texts.size(); ++i)
    if (rows.row(static_cast<Eigen::Index>(i)).isZero(0.f))
      throw Error(concat("encoder '", encoder_.identity().name, "' gave no embedding of '",
                         texts[i], "'; try other words"));
  const auto count = static_cast<Eigen::Index>(terms.size());
  const std::span<const std::string> all = texts;
  MatchScores scores = joined(all.first(terms.size()), rows.topRows(count), config_.terms);
  if (!negatives.empty())
    apply_negatives(
        joined(all.subspan(terms.size()), rows.bottomRows(rows.rows() - count), TermRule::kAny),
        scores);
  return scores;
}

MatchScores TextMatcher::joined(std::span<const std::string> texts, const Embeddings& rows,
                                TermRule rule) const {
  MatchScores scores;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    MatchScores term = scores_of(texts[i], rows.row(static_cast<Eigen::Index>(i)).transpose());
    if (i == 0)
      scores = std::move(term);
    else
      join(scores, term, rule);
  }
  scores.excluded.assign(index_.size(), false);
  scores.alternatives = rule == TermRule::kAny ? static_cast<int>(texts.size()) : 1;
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

Eigen::MatrixXf TextMatcher::fit_of_each(std::span<const std::string> texts) const {
  const Embeddings rows = encode_prompted(encoder_, texts, prompts_, TextUse::kVocabulary);
  Eigen::MatrixXf fits(static_cast<Eigen::Index>(index_.size()), rows.rows());
  parallel_for(texts.size(), 1, [&](std::size_t i) {
    const auto text = static_cast<Eigen::Index>(i);
    const Eigen::VectorXf row = rows.row(text).transpose();
    const Eigen::VectorXf pictures = calibration_->standard_scores(index_.cosines(row));
    fits.col(text) = evidence_ ? evidence_->weigh(texts[i], row, pictures).alone : pictures;
  });
  return fits;
}

double TextMatcher::p_value(const MatchScores& scores, float standard_score) const {
  // The best of several terms has several chances to score high (Sidak 1967).
  const double single = null_.p_value(double{standard_score});
  return -std::expm1(scores.alternatives * std::log1p(-single));
}

float TextMatcher::score_at(const MatchScores& scores, double p) const {
  const double single = -std::expm1(std::log1p(-p) / scores.alternatives);
  return static_cast<float>(null_.score_at(single));
}

double TextMatcher::probability(const MatchScores& scores, std::size_t position) const {
  const auto row = static_cast<Eigen::Index>(position);
  if (scores.log_odds.size() == 0) return match_probability(p_value(scores, scores.standard[row]));
  const double odds = double{config_.evidence.odds_scale} * double{scores.log_odds[row]} +
                      double{config_.evidence.odds_offset};
  return 1.0 / (1.0 + std::exp(-odds));
}

bool TextMatcher::is_found(const MatchScores& scores, std::size_t position) const {
  // The cheaper of the two first: a p-value is an integral.
  if (scores.log_odds.size() != 0 &&
      probability(scores, position) < double{config_.evidence.found_probability})
    return false;
  const float score = scores.standard[static_cast<Eigen::Index>(position)];
  return p_value(scores, score) <= double{config_.verdict.false_positive_rate};
}

}  // namespace ovimap
