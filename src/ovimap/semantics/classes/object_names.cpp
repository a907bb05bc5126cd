// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/classes/object_names.h"

#include <algorithm>
#include <cmath>

namespace ovimap {

namespace {

constexpr float kWide = 3.f;  // household words below a wide one

/// [words, words] 1 where the row's word names a kind of the column's.
Eigen::MatrixXf kinds_below(const Concepts& concepts) {
  const auto& words = concepts.household();
  const auto count = static_cast<Eigen::Index>(words.size());
  Eigen::MatrixXf below(count, count);
  for (Eigen::Index row = 0; row < count; ++row)
    for (Eigen::Index column = 0; column < count; ++column)
      below(row, column) = concepts.is_kind_of(words[static_cast<std::size_t>(row)].kind,
                                               words[static_cast<std::size_t>(column)].kind)
                               ? 1.f
                               : 0.f;
  return below;
}

/// What looks like a thing that somebody named is called so, where no clear word contradicts.
void name_by_examples(const TextEvidence& evidence, std::vector<ObjectName>& names) {
  if (evidence.config().taught_weight == 0.f) return;
  const Concepts& concepts = evidence.concepts();
  const auto nearest = evidence.taught().nearest();
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const auto& [example, ratio] = nearest[i];
    const float odds = ratio - evidence.config().taught_name_ratio;
    if (odds < 0.f) continue;
    const auto kinds = concepts.senses_of(example);
    if (names[i].clear() && !kinds.empty() &&
        !concepts.compatible(kinds, concepts.senses_of(names[i].word)))
      continue;
    names[i] = {example, 1.f / (1.f + std::exp(-odds))};
  }
}

}  // namespace

std::vector<ObjectName> name_objects(const TextEvidence& evidence) {
  const auto& words = evidence.concepts().household();
  const Eigen::MatrixXf below = kinds_below(evidence.concepts());
  const Eigen::VectorXf width = below.colwise().sum().transpose();
  const EvidenceConfig& config = evidence.config();
  const Eigen::VectorXf needed = width.unaryExpr([&](float kinds) {
    return kinds > kWide ? std::max(config.name_share, config.wide_name_share) : config.name_share;
  });
  const Eigen::MatrixXf& weights = evidence.household_weights();
  const Eigen::VectorXf total = weights.rowwise().sum();
  const Eigen::MatrixXf shares = total.cwiseInverse().asDiagonal() * (weights * below).eval();
  std::vector<ObjectName> names(static_cast<std::size_t>(shares.rows()));
  for (Eigen::Index i = 0; i < shares.rows(); ++i) {
    Eigen::Index best = -1;
    for (Eigen::Index word = 0; word < shares.cols(); ++word) {
      if (shares(i, word) < needed[word]) continue;
      const bool narrower = best < 0 || width[word] < width[best];
      const bool likelier =
          best >= 0 && width[word] == width[best] && shares(i, word) > shares(i, best);
      if (narrower || likelier) best = word;
    }
    if (best >= 0)
      names[static_cast<std::size_t>(i)] = {words[static_cast<std::size_t>(best)].word,
                                            std::min(shares(i, best), 1.f)};
  }
  name_by_examples(evidence, names);
  return names;
}

}  // namespace ovimap
