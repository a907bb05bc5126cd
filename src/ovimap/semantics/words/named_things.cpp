// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/named_things.h"

#include <algorithm>
#include <sstream>

#include "ovimap/semantics/views/appearance.h"

namespace ovimap {

NamedThings::NamedThings(const Concepts& concepts, const SeenThings& seen)
    : concepts_(concepts), ratios_(seen.log_ratios) {
  for (const std::string& words : seen.words) {
    Kinds& kinds = kinds_.emplace_back();
    std::istringstream parts(words);
    for (std::string word; std::getline(parts, word, '|');) {
      const Kinds senses = concepts_.senses_of(word);
      kinds.insert(kinds.end(), senses.begin(), senses.end());
    }
  }
  if (kinds_.empty()) return;
  const auto& household = concepts_.household();
  household_.setOnes(ratios_.rows(), static_cast<Eigen::Index>(household.size()));
  for (std::size_t word = 0; word < household.size(); ++word) {
    const Eigen::VectorXf ratios = of_named({household[word].kind});
    known_.push_back(ratios.size() > 0);
    if (known_.back()) household_.col(static_cast<Eigen::Index>(word)) = ratios.array().exp();
  }
}

Eigen::VectorXf NamedThings::of_named(const Kinds& kinds) const {
  const auto is_one = [&](Concepts::Kind thing) {
    return std::any_of(kinds.begin(), kinds.end(),
                       [&](Concepts::Kind kind) { return concepts_.is_kind_of(kind, thing); });
  };
  Eigen::VectorXf sum = Eigen::VectorXf::Zero(ratios_.rows());
  std::size_t names = 0;
  for (std::size_t thing = 0; thing < kinds_.size(); ++thing) {
    if (!std::any_of(kinds_[thing].begin(), kinds_[thing].end(), is_one)) continue;
    sum += ratios_.col(static_cast<Eigen::Index>(thing));
    ++names;
  }
  if (names == 0) return {};
  return sum.unaryExpr([names](float ratio) { return joint_log_ratio(ratio, names); });
}

Eigen::VectorXf NamedThings::log_ratios(std::string_view text) const {
  const Kinds kinds = concepts_.senses_of(text);
  if (kinds_.empty() || kinds.empty()) return {};
  if (Eigen::VectorXf named = of_named(kinds); named.size() > 0) return named;
  // A word for several things is as likely as they are on the mean.
  Eigen::VectorXf sum = Eigen::VectorXf::Zero(ratios_.rows());
  float below = 0.f;
  bool known = false;
  const auto& household = concepts_.household();
  for (std::size_t word = 0; word < household.size(); ++word) {
    const auto is_below = [&](Concepts::Kind kind) {
      return concepts_.is_kind_of(household[word].kind, kind);
    };
    if (!std::any_of(kinds.begin(), kinds.end(), is_below)) continue;
    sum += household_.col(static_cast<Eigen::Index>(word));
    below += 1.f;
    known = known || known_[word];
  }
  if (!known) return {};
  return (sum / below).array().log();
}

}  // namespace ovimap
