// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "ovimap/image/image.h"
#include "ovimap/semantics/query/query_matcher.h"
#include "ovimap/semantics/query/query_scene.h"

namespace ovimap {

struct Query {
  std::string text;  ///< free text, terms separated by commas, or a phrase of query_grammar.h
  std::vector<std::string> not_texts;  ///< what it must not be
  bool relevance = false;              ///< whether the answer shall rate every object
  std::vector<bool> among = {};  ///< [objects] which may be the answer; empty: all. What they stand
                                 ///< on or near may be any
};

struct QueryMatch {
  std::size_t position = 0;  ///< of the object in the index
  InstanceId id = 0;
  int part = 0;                       ///< of the object, where a part was asked for; 0: all of it
  Eigen::AlignedBox3f part_box;       ///< of that part; empty: all of it
  float score = 0;                    ///< cosine
  float standard_score = 0;           ///< standard deviations above unrelated things
  std::optional<double> p_value;      ///< chance that an absent thing's best object scores as high
  std::optional<double> probability;  ///< the model's own where it has one, else from p_value; of
                                      ///< the whole phrase where there is a relation
  std::string evidence;               ///< why a relation holds: "0.02 m above the top of #12"
};

/// How many things there are: the sum of the chances, and its standard deviation.
struct CountEstimate {
  double expected = 0, deviation = 0;
  int found = 0;  ///< of which it is true
};

struct QueryAnswer {
  std::string query;
  std::string reading;  ///< how a phrase was understood: "[mug] on [table]"; empty for free text
  std::string reason;   ///< why it was not found: "no [table] in the map", "did you mean 'chair'?";
                        ///< and what of it was not judged: "not judged: wooden"
  bool like_object =
      false;  ///< asked was what looks like an object, which is not among the matches
  Verdict verdict = Verdict::kNotInMap;
  std::vector<QueryMatch> matches;     ///< best first, also when the verdict is kNotInMap
  std::optional<CountEstimate> count;  ///< of "how many" and "two ..."
  Eigen::VectorXf relevance;  ///< [objects] in [0, 1], for heat maps; empty unless asked for
};

/// Answers queries on one map with one encoder (method section 11; docs/query.md). The index, the
/// encoder and the scene must outlive it. Calls are thread-safe.
class QueryEngine {
 public:
  /// `encoder` may be null: then only objects can be asked for. `vocabulary`: embeddings of
  /// TextMatcher::vocabulary_texts() where they are known already. Throws Error when the map has no
  /// embeddings, or of another length than the encoder's. Relations are those of the objects'
  /// boxes, with +z up.
  QueryEngine(const SearchIndex& index, ImageTextEncoder* encoder, const QueryConfig& config = {},
              Embeddings vocabulary = {});
  /// `scene`: geometry of relations, with a shape of each object, and what else is known of them.
  QueryEngine(const SearchIndex& index, ImageTextEncoder* encoder, const QueryConfig& config,
              Embeddings vocabulary, const QueryScene& scene);
  QueryEngine(const SearchIndex& index, ImageTextEncoder* encoder, const QueryConfig& config,
              Embeddings vocabulary, QueryScene&& scene) = delete;

  /// Throws Error for an empty or overlong text, or without encoder.
  QueryAnswer find(const Query& query) const;

  /// Objects that look like the picture; `name` is what the answer calls it. Throws Error without
  /// encoder or when it cannot embed the picture.
  QueryAnswer find_like(const RgbImage& image, const std::string& name,
                        bool relevance = false) const;

  /// Objects that look like that one, without itself. Throws Error for an unknown id or an object
  /// without embedding.
  QueryAnswer find_like(InstanceId id, bool relevance = false) const;

  /// Null without encoder.
  const TextMatcher* matcher() const { return matcher_ ? &*matcher_ : nullptr; }
  /// Of the objects' parts; made when it is first asked for. Null without encoder, or where no part
  /// has an embedding.
  const TextMatcher* part_matcher() const;

 private:
  using PValue = std::function<double(float standard_score)>;       // empty: no calibration
  using Probability = std::function<double(std::size_t position)>;  // empty: by p-value

  void prepare(Embeddings vocabulary);
  /// How many objects there are of what was asked for.
  CountEstimate count_all(const MatchScores& scores, const Probability& probability) const;
  QueryAnswer find_text(const std::string& text, const std::vector<std::string>& negatives,
                        const Query& query) const;
  QueryAnswer find_phrase(const QueryPhrase& phrase, const std::vector<std::string>& negatives,
                          const Query& query) const;
  Eigen::VectorXf relevance_of(const PhraseMatch& found) const;
  QueryMatch phrase_match(const PhraseMatch& found, std::size_t row) const;
  QueryAnswer answer(const MatchScores& scores, const PValue& p_value,
                     const Probability& probability, bool relevance) const;
  QueryAnswer answer_like(const Eigen::VectorXf& embedding, std::size_t itself,
                          bool relevance) const;
  bool is_found(const MatchScores& scores, const QueryMatch& best, const PValue& p_value) const;
  std::vector<QueryMatch> best_matches(const MatchScores& scores, RankRule rule,
                                       std::size_t count) const;
  Eigen::VectorXf rate_all(const MatchScores& scores, const PValue& p_value,
                           const Probability& probability) const;
  ImageTextEncoder& encoder() const;

  const SearchIndex& index_;
  ImageTextEncoder* encoder_;
  QueryConfig config_;
  std::optional<TextMatcher> matcher_;
  const QueryScene boxes_;  ///< where no other scene was given
  const QueryScene& scene_;
  mutable std::once_flag parts_asked_;
  mutable std::optional<TextMatcher> part_matcher_;
};

}  // namespace ovimap
