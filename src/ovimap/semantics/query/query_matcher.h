// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ovimap/semantics/query/query_config.h"
#include "ovimap/semantics/query/search_index.h"
#include "ovimap/semantics/words/written_words.h"

namespace ovimap {

/// How well each object matches a query.
struct MatchScores {
  Eigen::VectorXf cosines;   ///< [objects]
  Eigen::VectorXf standard;  ///< [objects] standard deviations above unrelated things
  Eigen::VectorXf log_odds;  ///< [objects] against other words for the object; empty: not known
  std::vector<bool> excluded;
  int alternatives = 1;  ///< terms of which the best counted
};

/// Scores texts against all objects of a map. The index and the encoder must outlive it.
/// Thread-safe.
class TextMatcher {
 public:
  /// `vocabulary`: embeddings of vocabulary_texts(); encoded here when it has no rows. Throws Error
  /// when the map has no embeddings or they are of another length than the encoder's or the
  /// vocabulary's. `measures`: of each object, or none where sizes are not known. `writing`: on
  /// each object, or none where it was not read. `things`: what a recognizer tells of each object.
  /// `taught`: what people named elsewhere.
  TextMatcher(const SearchIndex& index, ImageTextEncoder& encoder, const QueryConfig& config,
              Embeddings vocabulary, std::span<const ObjectMeasures> measures = {},
              std::span<const std::vector<WrittenLine>> writing = {}, const SeenThings& things = {},
              const TaughtThings& taught = {});

  /// The unrelated words that calibrate the verdict.
  static std::vector<std::string> vocabulary_texts();
  /// Their embeddings, as a matcher of that config takes them.
  static Embeddings encode_vocabulary(ImageTextEncoder& encoder, const QueryConfig& config);
  /// The words that evidence is weighed by (EvidenceConfig).
  static WordLists encode_word_lists(ImageTextEncoder& encoder, const QueryConfig& config);

  /// Matches with `terms` joined by the config's rule (at least one), less what `negatives` match
  /// better. Throws Error when the encoder has no embedding of a text.
  MatchScores match(const std::vector<std::string>& terms,
                    const std::vector<std::string>& negatives) const;

  /// [objects, texts] how well each text fits by itself, other words left out of account: what
  /// the classes of a closed set are compared by.
  Eigen::MatrixXf fit_of_each(std::span<const std::string> texts) const;

  /// Chance that a thing not in the map scores this high with its best object.
  double p_value(const MatchScores& scores, float standard_score) const;
  /// The standard score with that p-value, in (0, 1).
  float score_at(const MatchScores& scores, double p) const;
  /// Chance that the object at that position is what was asked for.
  double probability(const MatchScores& scores, std::size_t position) const;
  /// Whether that is enough to say that it was found: absent things hardly score as high (p-value),
  /// and other words do not explain the object better (probability).
  bool is_found(const MatchScores& scores, std::size_t position) const;

  const Embeddings& vocabulary() const { return vocabulary_; }
  const ScoreCalibration& calibration() const { return *calibration_; }
  /// Null where pictures alone decide.
  const TextEvidence* evidence() const { return evidence_ ? &*evidence_ : nullptr; }

 private:
  MatchScores scores_of(const std::string& text, const Eigen::VectorXf& row) const;
  MatchScores joined(std::span<const std::string> texts, const Embeddings& rows,
                     TermRule rule) const;
  void add_writing(const std::string& text, MatchScores& scores) const;
  void weigh_evidence(std::span<const ObjectMeasures> measures, const SeenThings& things,
                      const TaughtThings& taught);
  void apply_negatives(const MatchScores& negative, MatchScores& scores) const;

  const SearchIndex& index_;
  ImageTextEncoder& encoder_;
  QueryConfig config_;
  std::vector<std::string> prompts_;
  std::vector<std::vector<WrittenLine>> writing_;
  Embeddings vocabulary_;
  std::optional<ScoreCalibration> calibration_;
  std::optional<TextEvidence> evidence_;
  NullDistribution null_;  ///< of all evidence
};

/// Throws Error when no object of the index has an embedding.
void require_embeddings(const SearchIndex& index);

/// Throws Error when the index's embeddings cannot be of that encoder: `length` numbers against
/// those of `whose`.
void require_embedding_length(const SearchIndex& index, Eigen::Index length,
                              const std::string& whose);

}  // namespace ovimap
