// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/query_engine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>

#include "ovimap/base/error.h"
#include "ovimap/base/listed.h"
#include "ovimap/semantics/query/query_text.h"
#include "ovimap/semantics/words/materials.h"
#include "ovimap/semantics/words/spelling.h"

namespace ovimap {

namespace {

constexpr float kNeverRanked = std::numeric_limits<float>::lowest();

double model_probability(const MatchCalibration& model, float cosine) {
  return 1.0 / (1.0 + std::exp(-(double{model.scale} * double{cosine} + double{model.bias})));
}

/// Of objects that each are one by chance; `found`: how many are taken to be.
CountEstimate count_of(std::span<const double> chances, int found) {
  CountEstimate count{0, 0, found};
  for (const double chance : chances) {
    count.expected += chance;
    count.deviation += chance * (1.0 - chance);
  }
  count.deviation = std::sqrt(count.deviation);
  return count;
}

CountEstimate count_of(const PhraseMatch& match) {
  std::vector<double> chances;
  int found = 0;
  for (std::size_t i = 0; i < match.holds.size(); ++i) {
    chances.push_back(double{match.scores[static_cast<Eigen::Index>(i)]});
    found += match.holds[i] && chances.back() > 0.0;
  }
  return count_of(chances, found);
}

void collect_materials(const QueryPhrase& phrase, std::vector<std::string>& words) {
  for (const std::string& term : split_terms(phrase.things))
    for (std::string& word : material_words(term, builtin_concepts()))
      if (std::find(words.begin(), words.end(), word) == words.end())
        words.push_back(std::move(word));
  for (const QueryPhrase& anchor : phrase.anchors) collect_materials(anchor, words);
}

void add_reason(QueryAnswer& answer, const std::string& reason) {
  answer.reason += concat(answer.reason.empty() ? "" : "; ", reason);
}

/// What is not found may be misspelt.
void suggest_words(const QueryPhrase& phrase, QueryAnswer& answer) {
  for (const std::string& term : split_terms(phrase.things))
    if (const std::string meant = meant_word(term, builtin_concepts()); !meant.empty())
      add_reason(answer, concat("did you mean '", meant, "'?"));
  for (const QueryPhrase& anchor : phrase.anchors) suggest_words(anchor, answer);
}

/// An answer must not look as if it had judged what nothing in it tells.
void admit_unjudged(const QueryPhrase& phrase, QueryAnswer& answer) {
  std::vector<std::string> words;
  collect_materials(phrase, words);
  if (words.empty()) return;
  add_reason(answer, concat("not judged: ", listed(words)));
}

bool asks_for_parts(const QueryPhrase& phrase) {
  return phrase.relation == Relation::kPartOf ||
         std::any_of(phrase.anchors.begin(), phrase.anchors.end(), asks_for_parts);
}

std::vector<std::size_t> some_embedded(const SearchIndex& index, std::size_t most) {
  std::vector<std::size_t> positions;
  for (std::size_t i = 0; i < index.size(); ++i)
    if (index.has_embedding(i)) positions.push_back(i);
  if (positions.size() <= most) return positions;
  std::vector<std::size_t> some(most);
  for (std::size_t i = 0; i < most; ++i) some[i] = positions[i * positions.size() / most];
  return some;
}

}  // namespace

QueryEngine::QueryEngine(const SearchIndex& index, ImageTextEncoder* encoder,
                         const QueryConfig& config, Embeddings vocabulary)
    : index_(index),
      encoder_(encoder),
      config_(config),
      boxes_(scene_of_boxes(index, Eigen::Vector3f::UnitZ())),
      scene_(boxes_) {
  prepare(std::move(vocabulary));
}

QueryEngine::QueryEngine(const SearchIndex& index, ImageTextEncoder* encoder,
                         const QueryConfig& config, Embeddings vocabulary, const QueryScene& scene)
    : index_(index), encoder_(encoder), config_(config), scene_(scene) {
  OVIMAP_ASSERT(scene.shapes.size() == index.size());
  prepare(std::move(vocabulary));
}

void QueryEngine::prepare(Embeddings vocabulary) {
  require_embeddings(index_);
  if (encoder_)
    matcher_.emplace(index_, *encoder_, config_, std::move(vocabulary), scene_.shapes.measures(),
                     scene_.writing, scene_.things, scene_.taught);
}

const TextMatcher* QueryEngine::part_matcher() const {
  if (!scene_.parts || scene_.parts->index.embedded() == 0 || !encoder_) return nullptr;
  std::call_once(parts_asked_, [&] {
    part_matcher_.emplace(scene_.parts->index, *encoder_, config_, matcher_->vocabulary(),
                          scene_.parts->scene.shapes.measures());
  });
  return &*part_matcher_;
}

QueryAnswer QueryEngine::find(const Query& query) const {
  const std::string text = checked_query_text(query.text, config_.max_text_chars);
  std::vector<std::string> negatives;
  for (const std::string& negative : query.not_texts)
    for (std::string& term : split_terms(checked_query_text(negative, config_.max_text_chars)))
      negatives.push_back(std::move(term));
  QueryPhrase phrase;
  phrase.things = text;
  if (config_.grammar && !index_.is_name(text))
    phrase =
        parse_query(text, {.colors = scene_.colors != nullptr, .parts = scene_.parts != nullptr});
  QueryAnswer result = phrase.free_text() ? find_text(text, negatives, query)
                                          : find_phrase(phrase, negatives, query);
  result.query = text;
  admit_unjudged(phrase, result);
  if (result.verdict != Verdict::kFound) suggest_words(phrase, result);
  return result;
}

CountEstimate QueryEngine::count_all(const MatchScores& scores,
                                     const Probability& probability) const {
  std::vector<double> chances;
  int found = 0;
  for (std::size_t i = 0; i < index_.size(); ++i) {
    if (scores.excluded[i] || !index_.has_embedding(i)) continue;
    chances.push_back(probability(i));
    found += scores.log_odds.size() > 0 ? matcher_->is_found(scores, i) : chances.back() > 0.5;
  }
  return count_of(chances, found);
}

QueryAnswer QueryEngine::find_text(const std::string& text,
                                   const std::vector<std::string>& negatives,
                                   const Query& query) const {
  const std::vector<std::string> terms = split_terms(text);
  if (terms.empty())
    throw Error(concat("the query '", text, "' names nothing; say what to look for"));
  const auto model = encoder().calibration();
  MatchScores scores = matcher_->match(terms, negatives);
  if (!query.among.empty())
    for (std::size_t i = 0; i < index_.size(); ++i)
      if (!query.among[i]) scores.excluded[i] = true;
  const PValue p_value = [&](float score) { return matcher_->p_value(scores, score); };
  const Probability probability = [&](std::size_t position) {
    return model ? model_probability(*model, scores.cosines[static_cast<Eigen::Index>(position)])
                 : matcher_->probability(scores, position);
  };
  QueryAnswer result = answer(scores, p_value, probability, query.relevance);
  if (terms.size() == 1 && !index_.is_name(terms[0]) && asks_for_all(terms[0])) {
    result.reading = concat("all [", thing_of_term(terms[0]), "]");
    result.count = count_all(scores, probability);
  }
  return result;
}

QueryAnswer QueryEngine::find_phrase(const QueryPhrase& phrase,
                                     const std::vector<std::string>& negatives,
                                     const Query& query) const {
  const PhraseSearch search(index_, matcher(), scene_, config_, query.among,
                            asks_for_parts(phrase) ? part_matcher() : nullptr);
  const PhraseMatch found = search.match(phrase, negatives);
  QueryAnswer result;
  result.reading = describe(phrase);
  std::vector<std::size_t> order;
  bool any_holds = false;
  const SearchIndex& asked = found.of_parts ? scene_.parts->index : index_;
  for (std::size_t i = 0; i < asked.size(); ++i)
    if (found.scores[static_cast<Eigen::Index>(i)] > 0.f) {
      order.push_back(i);
      any_holds = any_holds || found.holds[i];
    }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(-found.scores[static_cast<Eigen::Index>(a)], asked.object(a).id) <
           std::tuple(-found.scores[static_cast<Eigen::Index>(b)], asked.object(b).id);
  });
  if (phrase.how_many || phrase.count > 0) result.count = count_of(found);
  std::size_t shown = static_cast<std::size_t>(config_.top_k);
  if (phrase.count > 0) shown = static_cast<std::size_t>(phrase.count);
  if (phrase.how_many) shown = static_cast<std::size_t>(std::max(result.count->found, 1));
  order.resize(std::min(order.size(), shown));
  for (const std::size_t row : order) result.matches.push_back(phrase_match(found, row));
  const bool enough = !result.count || result.count->found >= std::max(phrase.count, 1);
  if (found.missing.empty() && any_holds && enough) result.verdict = Verdict::kFound;
  for (const std::string& things : found.missing)
    result.reason += concat(result.reason.empty() ? "" : ", ", "no [", things, "] in the map");
  if (found.missing.empty() && !any_holds) result.reason = "for nothing in the map is this true";
  if (found.missing.empty() && any_holds && !enough)
    result.reason = concat("only ", result.count->found, " of ", phrase.count);
  if (query.relevance) result.relevance = relevance_of(found);
  return result;
}

Eigen::VectorXf QueryEngine::relevance_of(const PhraseMatch& found) const {
  if (!found.of_parts) return found.scores;
  Eigen::VectorXf relevance = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(index_.size()));
  for (std::size_t p = 0; p < scene_.parts->index.size(); ++p) {
    float& best = relevance[static_cast<Eigen::Index>(scene_.parts->owners[p])];
    best = std::max(best, found.scores[static_cast<Eigen::Index>(p)]);
  }
  return relevance;
}

QueryMatch QueryEngine::phrase_match(const PhraseMatch& found, std::size_t row) const {
  const auto i = static_cast<Eigen::Index>(row);
  QueryMatch match;
  match.position = found.of_parts ? scene_.parts->owners[row] : row;
  match.id = index_.object(match.position).id;
  if (found.of_parts) {
    match.part = scene_.parts->numbers[row];
    match.part_box = scene_.parts->index.object(row).box;
  }
  match.probability = double{found.scores[i]};
  match.evidence = found.evidence[row];
  if (found.things.standard.size() == 0) return match;  // "anything"
  match.score = found.things.cosines[i];
  match.standard_score = found.things.standard[i];
  const TextMatcher& matcher = found.of_parts ? *part_matcher() : *matcher_;
  match.p_value = matcher.p_value(found.things, match.standard_score);
  return match;
}

QueryAnswer QueryEngine::find_like(const RgbImage& image, const std::string& name,
                                   bool relevance) const {
  const Embeddings row = encoder().encode_images({&image, 1});
  if (row.isZero(0.f)) throw Error(concat("the encoder gave no embedding of ", name));
  QueryAnswer result = answer_like(row.row(0).transpose(), ScoreCalibration::kNoObject, relevance);
  result.query = name;
  return result;
}

QueryAnswer QueryEngine::find_like(InstanceId id, bool relevance) const {
  const std::optional<std::size_t> itself = index_.find(id);
  if (!itself) throw Error(concat("the map has no object ", id, "; `ovimap info` lists them"));
  if (!index_.has_embedding(*itself))
    throw Error(concat("object ", id, " has no embedding; choose one that was seen better"));
  const auto row = index_.embeddings().row(static_cast<Eigen::Index>(*itself));
  QueryAnswer result = answer_like(row.transpose(), *itself, relevance);
  result.query = concat("#", id);
  result.like_object = true;
  return result;
}

QueryAnswer QueryEngine::answer_like(const Eigen::VectorXf& embedding, std::size_t itself,
                                     bool relevance) const {
  MatchScores scores;
  scores.cosines = index_.cosines(embedding);
  scores.excluded.assign(index_.size(), false);
  if (itself != ScoreCalibration::kNoObject) scores.excluded[itself] = true;

  // The map's own objects say what pictures of different things have in common.
  const std::vector<std::size_t> own =
      some_embedded(index_, static_cast<std::size_t>(config_.max_like_references));
  if (own.size() < static_cast<std::size_t>(config_.verdict.min_references)) {
    scores.standard = scores.cosines;
    QueryAnswer result = answer(scores, {}, {}, relevance);
    result.reason = concat("the best of ", own.size(),
                           " objects; too few to tell whether it is a match at all");
    return result;
  }
  Embeddings references(static_cast<Eigen::Index>(own.size()), index_.dimension());
  for (std::size_t i = 0; i < own.size(); ++i)
    references.row(static_cast<Eigen::Index>(i)) =
        index_.embeddings().row(static_cast<Eigen::Index>(own[i]));
  const ScoreCalibration calibration(index_, references, config_.verdict, own);
  scores.standard = calibration.standard_scores(scores.cosines);
  const PValue p_value = [&](float score) {
    return calibration.null_distribution().p_value(double{score});
  };
  return answer(scores, p_value, {}, relevance);
}

std::vector<QueryMatch> QueryEngine::best_matches(const MatchScores& scores, RankRule rule,
                                                  std::size_t count) const {
  Eigen::VectorXf ranked = rule == RankRule::kCosine ? scores.cosines : scores.standard;
  for (std::size_t i = 0; i < scores.excluded.size(); ++i)
    if (scores.excluded[i]) ranked[static_cast<Eigen::Index>(i)] = kNeverRanked;
  std::vector<QueryMatch> matches;
  for (const std::size_t position : index_.best(ranked, count)) {
    if (scores.excluded[position]) break;
    const auto row = static_cast<Eigen::Index>(position);
    matches.push_back({position,
                       index_.object(position).id,
                       0,
                       {},
                       scores.cosines[row],
                       scores.standard[row],
                       {},
                       {},
                       {}});
  }
  return matches;
}

bool QueryEngine::is_found(const MatchScores& scores, const QueryMatch& best,
                           const PValue& p_value) const {
  if (matcher_ && scores.log_odds.size() > 0) return matcher_->is_found(scores, best.position);
  return !p_value || p_value(best.standard_score) <= double{config_.verdict.false_positive_rate};
}

QueryAnswer QueryEngine::answer(const MatchScores& scores, const PValue& p_value,
                                const Probability& probability, bool relevance) const {
  QueryAnswer result;
  result.matches = best_matches(scores, config_.rank_by, static_cast<std::size_t>(config_.top_k));
  const auto best = best_matches(scores, RankRule::kStandardScore, 1);
  if (!best.empty() && is_found(scores, best[0], p_value)) result.verdict = Verdict::kFound;
  for (QueryMatch& match : result.matches) {
    if (!p_value) break;
    match.p_value = p_value(match.standard_score);
    match.probability =
        probability ? probability(match.position) : match_probability(*match.p_value);
  }
  if (relevance) result.relevance = rate_all(scores, p_value, probability);
  return result;
}

Eigen::VectorXf QueryEngine::rate_all(const MatchScores& scores, const PValue& p_value,
                                      const Probability& probability) const {
  Eigen::VectorXf relevance = scores.cosines.cwiseMax(0.f);
  for (std::size_t i = 0; i < index_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (!index_.has_embedding(i) || scores.excluded[i])
      relevance[row] = 0.f;
    else if (probability)
      relevance[row] = static_cast<float>(probability(i));
    else if (p_value)
      relevance[row] = static_cast<float>(match_probability(p_value(scores.standard[row])));
  }
  return relevance;
}

ImageTextEncoder& QueryEngine::encoder() const {
  if (!encoder_)
    throw Error("a text or picture needs an encoder, none was given; name one with --encoder");
  return *encoder_;
}

}  // namespace ovimap
