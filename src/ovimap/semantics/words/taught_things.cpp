// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/taught_things.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/error.h"
#include "ovimap/base/text/ascii.h"

namespace ovimap {

namespace {

// How much more often looks of one kind are so alike than looks of different kinds, as logarithm,
// of the standard deviations by which their angle is smaller than that of different things in the
// mean (tools/models/calibrate_teaching.py). Angles, since cosines are crowded where looks are
// nearly the same.
constexpr float kSlope = 2.f, kConstant = -1.5f;
constexpr float kLeastRatio = -1.f;          // an unlike look may be another side of the same
constexpr Eigen::Index kLeastStrangers = 8;  // objects that say how alike different things are
constexpr Eigen::Index kMostStrangers = 512;
constexpr float kLeastDeviation = 1e-3f;  // radians

float angle_of(float cosine) {
  return std::acos(std::clamp(cosine, -1.f, 1.f));
}

/// How alike different things of a map are: mean and standard deviation of the angles of pairs.
struct Strangers {
  float mean = 0, deviation = 0;
  bool known = false;

  float log_ratio(float cosine) const {
    return std::max(kSlope * (mean - angle_of(cosine)) / deviation + kConstant, kLeastRatio);
  }
};

/// `looks` [objects, dimension]: rows of length 1 or 0.
Strangers strangers_of(const Embeddings& looks) {
  std::vector<Eigen::Index> seen;
  for (Eigen::Index row = 0; row < looks.rows(); ++row)
    if (!looks.row(row).isZero(0.f)) seen.push_back(row);
  const auto known = static_cast<Eigen::Index>(seen.size());
  if (known < kLeastStrangers) return {};
  Embeddings some(std::min(known, kMostStrangers), looks.cols());
  for (Eigen::Index row = 0; row < some.rows(); ++row)
    some.row(row) = looks.row(seen[static_cast<std::size_t>(row * known / some.rows())]);
  const Eigen::MatrixXf angles = (some * some.transpose()).unaryExpr(&angle_of);
  const auto pairs = static_cast<float>(some.rows() * (some.rows() - 1));
  Strangers found;
  found.mean = (angles.sum() - angles.trace()) / pairs;
  const Eigen::MatrixXf apart = (angles.array() - found.mean).square().matrix();
  found.deviation = std::max(std::sqrt((apart.sum() - apart.trace()) / pairs), kLeastDeviation);
  found.known = true;
  return found;
}

}  // namespace

TaughtNames::TaughtNames(const Concepts& concepts, const TaughtThings& own,
                         const TaughtThings& things)
    : concepts_(&concepts), names_(things.names) {
  const auto others = static_cast<Eigen::Index>(names_.size());
  if (others > 0 && things.looks.cols() != own.looks.cols())
    throw Error(concat("examples of names have looks of ", things.looks.cols(),
                       " numbers, the map's have ", own.looks.cols(),
                       "; take those of the map's encoder"));
  std::vector<Eigen::Index> named;
  for (std::size_t i = 0; i < own.names.size(); ++i)
    if (!own.names[i].empty())
      named.push_back(static_cast<Eigen::Index>(i)), names_.push_back(own.names[i]);
  if (names_.empty()) return;
  for (const std::string& name : names_) {
    folded_.push_back(lower_case(name));
    kinds_.push_back(concepts.senses_of(name));
  }

  const Strangers strangers = strangers_of(own.looks);
  ratios_.setZero(own.looks.rows(), static_cast<Eigen::Index>(names_.size()));
  for (Eigen::Index example = 0; example < ratios_.cols(); ++example) {
    const bool is_own = example >= others;
    const Eigen::Index itself = is_own ? named[static_cast<std::size_t>(example - others)] : 0;
    const Eigen::VectorXf look =
        (is_own ? own.looks.row(itself) : things.looks.row(example)).transpose();
    for (Eigen::Index object = 0; strangers.known && object < ratios_.rows(); ++object)
      if (!look.isZero(0.f) && !own.looks.row(object).isZero(0.f))
        ratios_(object, example) = strangers.log_ratio(own.looks.row(object).dot(look));
    if (is_own) ratios_(itself, example) = kCertain;
  }
}

/// Anna's vase is a vase, and a wooden chair may be one like the chair; Anna's vase is not Tom's.
bool TaughtNames::is_named(const std::string& text, const Kinds& kinds, bool whole,
                           std::size_t example) const {
  const std::string& name = folded_[example];
  if (name == text) return true;
  if (!whole) return concepts_->knows(name) && text.ends_with(" " + name);
  return std::any_of(kinds_[example].begin(), kinds_[example].end(), [&](Concepts::Kind kind) {
    return std::any_of(kinds.begin(), kinds.end(),
                       [&](Concepts::Kind of) { return concepts_->is_kind_of(kind, of); });
  });
}

Eigen::VectorXf TaughtNames::log_ratios(std::string_view text) const {
  if (names_.empty()) return {};
  const std::string folded = lower_case(text);
  const Kinds kinds = concepts_->senses_of(folded);
  const bool whole = concepts_->knows(folded);
  Eigen::VectorXf most;
  for (std::size_t example = 0; example < names_.size(); ++example) {
    if (!is_named(folded, kinds, whole, example)) continue;
    const auto column = ratios_.col(static_cast<Eigen::Index>(example));
    most = most.size() == 0 ? Eigen::VectorXf(column) : Eigen::VectorXf(most.cwiseMax(column));
  }
  return most;
}

std::vector<TaughtNames::Likeness> TaughtNames::nearest() const {
  std::vector<Likeness> result;
  for (Eigen::Index object = 0; object < ratios_.rows(); ++object) {
    Eigen::Index best = 0;
    const float ratio = ratios_.row(object).maxCoeff(&best);
    result.push_back({names_[static_cast<std::size_t>(best)], ratio});
  }
  return result;
}

}  // namespace ovimap
