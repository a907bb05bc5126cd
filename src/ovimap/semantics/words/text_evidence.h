// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "ovimap/inference/encoders/image_text_encoder.h"
#include "ovimap/semantics/words/concepts.h"
#include "ovimap/semantics/words/named_things.h"
#include "ovimap/semantics/words/taught_things.h"
#include "ovimap/semantics/words/thing_sizes.h"

namespace ovimap {

class ConfigFields;

struct EvidenceConfig {
  float size_weight = 0.5f;          ///< of size and place beside the picture; 0: the picture alone
  float most_size_ratio = 3.f;       ///< what they may say at most, in log likelihood
  float structure_weight = 2.f;      ///< of size and place for floor, wall and ceiling
  float most_structure_ratio = 6.f;  ///< what they may say of these at most
  float thing_weight = 0.25f;        ///< of what a recognizer of things tells; 0: nothing
  float most_thing_ratio = 6.f;      ///< what it may say at most, in log likelihood
  float taught_weight = 1.f;         ///< of what people named; 0: nothing
  float most_taught_ratio = 6.f;     ///< what it may say at most, in log likelihood
  float taught_name_ratio = 4.f;     ///< log likelihood that shows an example's own name
  float writing_weight = 3.f;        ///< of words that are written on the object; 0: none
  float competition = 0.5f;        ///< how much other words for an object take from a text; 0: none
  float odds_scale = 1.f;          ///< probability of a match: sigmoid(scale * log odds + offset)
  float odds_offset = 2.3f;        ///< fitted on generated rooms (docs/experiments.md)
  float found_probability = 0.4f;  ///< a match with less does not count as found
  float name_share = 0.5f;         ///< of all household words, that a name needs to be shown
  float wide_name_share = 0.6f;    ///< ... a name of more than three kinds ("furniture")
  int max_objects = 50000;         ///< larger maps are searched by pictures alone
};
void list_fields(EvidenceConfig& config, ConfigFields& fields);

/// What speaks for a text, object by object.
struct TextScores {
  Eigen::VectorXf alone;     ///< [objects] by picture and size, other words left out of account
  Eigen::VectorXf standard;  ///< [objects] standard deviations above unrelated things
  Eigen::VectorXf log_odds;  ///< [objects] against all other household words; empty: not known
};

/// The kinds of things that are compiled in.
const Concepts& builtin_concepts();

/// The words that evidence is weighed by, and an encoder's embeddings of them.
struct WordLists {
  std::vector<std::string> texts;  ///< household words, then things of known size
  Embeddings rows;
};

/// Adds to what pictures say of a text what size and place say, and lets words compete: one thing
/// is one thing, so what is rather a monitor is no keyboard (docs/query.md). Words for the same
/// thing (a chair is a seat) do not compete. Immutable, of one map and one encoder.
class TextEvidence {
 public:
  /// [objects] standard scores of the picture alone, for an embedding of a text.
  using PictureScores = std::function<Eigen::VectorXf(const Eigen::VectorXf&)>;

  /// `objects`: measures of each, or none where they are not known. `lists`: as word_lists() gives
  /// them, with `encode` for the prompts. `seen`: what a recognizer tells of each object. `taught`:
  /// what people named.
  TextEvidence(std::span<const ObjectMeasures> objects, const SeenThings& seen, TaughtNames taught,
               const WordLists& lists, const PictureScores& pictures, const EvidenceConfig& config);

  /// The texts that WordLists holds.
  static std::vector<std::string> texts();

  /// `row`: the text's embedding, `pictures`: its standard scores [objects] by picture alone.
  TextScores weigh(const std::string& text, const Eigen::VectorXf& row,
                   const Eigen::VectorXf& pictures) const;

  const EvidenceConfig& config() const { return config_; }
  const Concepts& concepts() const { return concepts_; }
  const TaughtNames& taught() const { return taught_; }
  /// [objects, household words] exp(score - the object's best).
  const Eigen::MatrixXf& household_weights() const { return weights_; }

 private:
  /// Adds what size and place say of the text to its scores [objects].
  void add_size(const Eigen::VectorXf& row, Eigen::VectorXf& scores) const;
  /// Adds what a recognizer says of it.
  void add_things(const std::string& text, Eigen::VectorXf& scores) const;
  /// Adds what people taught of it.
  void add_taught(const std::string& text, Eigen::VectorXf& scores) const;
  Eigen::VectorXf competitors(const std::string& text, const Eigen::VectorXf& row) const;

  EvidenceConfig config_;
  const Concepts& concepts_;
  NamedThings things_;
  TaughtNames taught_;
  Embeddings household_rows_, thing_rows_;
  float mean_cosine_ = 0, cosine_deviation_ = 1;  ///< between household words
  std::vector<bool> structures_;  ///< of each thing of known size: whether a room consists of it
  Eigen::MatrixXf sizes_;         ///< [objects, things] likelihoods; no columns: not known
  Eigen::VectorXf size_means_;    ///< [objects] over all things
  Eigen::MatrixXf weights_;       ///< [objects, household words]
  Eigen::VectorXf best_, total_;  ///< [objects]
};

}  // namespace ovimap
