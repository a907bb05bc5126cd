// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/text_evidence.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/semantics/words/word_lists.h"

namespace ovimap {

namespace {

// How alike two texts are, in standard deviations of the cosines between household words.
constexpr float kSoftness = 0.6f;                 // of the choice of things a text is like
constexpr float kUnlike = 2.f, kAlike = 5.5f;     // a thing whose size says nothing, or all
constexpr float kRival = 3.6f, kSameThing = 6.f;  // texts that compete, or not at all
constexpr float kSmallestShare = 1e-3f;           // of a text among the things it is like
constexpr float kLeastLikelihood = 1e-4f;
constexpr float kLeastRivals = 1e-3f;  // share of all words that always competes
constexpr float kPersonsWord = 20.f;   // log likelihood ratio that nothing seen outweighs
constexpr std::size_t kSizedObjectsPerTask = 64;

/// What a room consists of: encoders of things have seen little of it, and its size and place are
/// like nothing else's.
bool is_structure(const ThingSize& thing) {
  return thing.word == "floor" || thing.word == "wall" || thing.word == "ceiling";
}

float ramp(float value, float from, float to) {
  return std::clamp((value - from) / (to - from), 0.f, 1.f);
}

}  // namespace

const Concepts& builtin_concepts() {
  static const Concepts concepts(list_entries(builtin_word_list("concepts")));
  return concepts;
}

void list_fields(EvidenceConfig& config, ConfigFields& fields) {
  constexpr int kMost = 100000000;
  fields.add("size_weight", config.size_weight, 0.f, 10.f,
             "weight of size and place beside the picture; 0: the picture alone");
  fields.add("most_size_ratio", config.most_size_ratio, 0.f, 100.f,
             "what size and place may say at most, log likelihood");
  fields.add(
      "structure_weight", config.structure_weight, 0.f, 10.f,
      "weight of size and place for floor, wall and ceiling, which they tell better than pictures");
  fields.add("most_structure_ratio", config.most_structure_ratio, 0.f, 100.f,
             "what they may say of these at most, log likelihood");
  fields.add("thing_weight", config.thing_weight, 0.f, 10.f,
             "weight of what a recognizer of things tells; 0: nothing");
  fields.add("most_thing_ratio", config.most_thing_ratio, 0.f, 100.f,
             "what a recognizer may say at most, log likelihood");
  fields.add("taught_weight", config.taught_weight, 0.f, 10.f,
             "weight of what people named, in this map or in those that taught; 0: nothing");
  fields.add("most_taught_ratio", config.most_taught_ratio, 0.f, 100.f,
             "what a named thing may say of another at most, log likelihood");
  fields.add("taught_name_ratio", config.taught_name_ratio, 0.f, 100.f,
             "log likelihood from which an object is called by the name of what it resembles");
  fields.add("writing_weight", config.writing_weight, 0.f, 100.f,
             "what a text that is written on the object adds to its score; 0: nothing");
  fields.add("competition", config.competition, 0.f, 1.f,
             "how much better words for an object take from a text; 0: nothing");
  fields.add("odds_scale", config.odds_scale, 0.01f, 100.f,
             "probability of a match: sigmoid(odds_scale * log odds + odds_offset)");
  fields.add("odds_offset", config.odds_offset, -100.f, 100.f, "... see odds_scale");
  fields.add("found_probability", config.found_probability, 0.f, 1.f,
             "a match with a smaller probability does not count as found");
  fields.add("name_share", config.name_share, 0.01f, 1.f,
             "share of all household words that a name needs to be shown; else it is an object");
  fields.add("wide_name_share", config.wide_name_share, 0.01f, 1.f,
             "... for a name of more than three household words, such as furniture");
  fields.add("max_objects", config.max_objects, 0, kMost,
             "maps of more objects are searched by pictures alone");
}

std::vector<std::string> TextEvidence::texts() {
  std::vector<std::string> texts;
  for (const auto& [word, kind] : builtin_concepts().household()) texts.push_back(word);
  for (const ThingSize& thing : builtin_thing_sizes()) texts.push_back(thing.word);
  return texts;
}

TextEvidence::TextEvidence(std::span<const ObjectMeasures> objects, const SeenThings& seen,
                           TaughtNames taught, const WordLists& lists,
                           const PictureScores& pictures, const EvidenceConfig& config)
    : config_(config),
      concepts_(builtin_concepts()),
      things_(concepts_, seen),
      taught_(std::move(taught)) {
  const auto words = static_cast<Eigen::Index>(concepts_.household().size());
  household_rows_ = lists.rows.topRows(words);
  thing_rows_ = lists.rows.bottomRows(lists.rows.rows() - words);
  const Eigen::MatrixXf cosines = household_rows_ * household_rows_.transpose();
  const float pairs = static_cast<float>(words * (words - 1));
  mean_cosine_ = (cosines.sum() - cosines.trace()) / pairs;
  const auto apart = (cosines.array() - mean_cosine_).square();
  cosine_deviation_ =
      std::sqrt(std::max((apart.sum() - apart.matrix().diagonal().sum()) / pairs, 1e-12f));

  const std::vector<ThingSize>& things = builtin_thing_sizes();
  for (const ThingSize& thing : things) structures_.push_back(is_structure(thing));
  sizes_.resize(static_cast<Eigen::Index>(objects.size()),
                objects.empty() ? 0 : static_cast<Eigen::Index>(things.size()));
  parallel_for(objects.size(), kSizedObjectsPerTask, [&](std::size_t i) {
    const std::vector<float> fits = size_likelihoods(objects[i], things);
    sizes_.row(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Eigen::RowVectorXf>(fits.data(), sizes_.cols());
  });
  if (sizes_.cols() > 0) size_means_ = sizes_.rowwise().mean();

  std::vector<Eigen::VectorXf> columns(static_cast<std::size_t>(words));
  parallel_for(columns.size(), 1, [&](std::size_t word) {
    const Eigen::VectorXf row = household_rows_.row(static_cast<Eigen::Index>(word)).transpose();
    columns[word] = pictures(row);
    add_size(row, columns[word]);
    add_things(concepts_.household()[word].word, columns[word]);
    add_taught(concepts_.household()[word].word, columns[word]);
  });
  weights_.resize(columns[0].size(), words);
  for (Eigen::Index word = 0; word < words; ++word)
    weights_.col(word) = columns[static_cast<std::size_t>(word)];
  best_ = weights_.rowwise().maxCoeff();
  weights_ = (weights_.colwise() - best_).array().exp();
  total_ = weights_.rowwise().sum();
}

void TextEvidence::add_size(const Eigen::VectorXf& row, Eigen::VectorXf& scores) const {
  if (sizes_.cols() == 0 || config_.size_weight == 0.f) return;
  const Eigen::VectorXf alike = ((thing_rows_ * row).array() - mean_cosine_) / cosine_deviation_;
  const float nearest = alike.maxCoeff(), certainty = ramp(nearest, kUnlike, kAlike);
  if (certainty == 0.f) return;
  Eigen::VectorXf fit = Eigen::VectorXf::Zero(sizes_.rows());
  float shares = 0.f, structure = 0.f;
  for (Eigen::Index k = 0; k < alike.size(); ++k) {
    const float share = std::exp((alike[k] - nearest) / kSoftness);
    if (share < kSmallestShare) continue;
    fit += share * sizes_.col(k);
    shares += share;
    if (structures_[static_cast<std::size_t>(k)]) structure += share;
  }
  structure /= shares;
  const Eigen::ArrayXf ratio = (fit.array() / shares + kLeastLikelihood).log() -
                               (size_means_.array() + kLeastLikelihood).log();
  const auto between = [structure](float thing, float of_structure) {
    return thing + structure * (of_structure - thing);
  };
  const float most = between(config_.most_size_ratio, config_.most_structure_ratio);
  const float weight = between(config_.size_weight, config_.structure_weight);
  scores.array() += weight * certainty * ratio.cwiseMax(-most).cwiseMin(most);
}

void TextEvidence::add_things(const std::string& text, Eigen::VectorXf& scores) const {
  const Eigen::VectorXf ratios = things_.log_ratios(text);
  const float most = config_.most_thing_ratio;
  if (ratios.size() > 0)
    scores.array() += config_.thing_weight * ratios.array().cwiseMax(-most).cwiseMin(most);
}

void TextEvidence::add_taught(const std::string& text, Eigen::VectorXf& scores) const {
  const Eigen::VectorXf ratios = taught_.log_ratios(text);
  const float most = config_.most_taught_ratio;
  if (ratios.size() == 0) return;
  scores += config_.taught_weight * ratios.unaryExpr([most](float ratio) {
    return ratio == TaughtNames::kCertain ? kPersonsWord : std::clamp(ratio, -most, most);
  });
}

Eigen::VectorXf TextEvidence::competitors(const std::string& text,
                                          const Eigen::VectorXf& row) const {
  const auto kinds = concepts_.kinds_of(text);
  const Eigen::VectorXf alike =
      ((household_rows_ * row).array() - mean_cosine_) / cosine_deviation_;
  Eigen::VectorXf rivals = total_;
  for (Eigen::Index word = 0; word < alike.size(); ++word) {
    const auto kind = concepts_.household()[static_cast<std::size_t>(word)].kind;
    const float same =
        concepts_.compatible(kinds, {kind}) ? 1.f : ramp(alike[word], kRival, kSameThing);
    if (same > 0.f) rivals -= same * weights_.col(word);
  }
  return rivals.cwiseMax(kLeastRivals * total_);
}

TextScores TextEvidence::weigh(const std::string& text, const Eigen::VectorXf& row,
                               const Eigen::VectorXf& pictures) const {
  TextScores scores;
  scores.alone = pictures;
  add_size(row, scores.alone);
  add_things(text, scores.alone);
  add_taught(text, scores.alone);
  const Eigen::VectorXf rivals = best_.array() + competitors(text, row).array().log();
  scores.log_odds = scores.alone - rivals;
  scores.standard = scores.alone - config_.competition * rivals;
  return scores;
}

}  // namespace ovimap
