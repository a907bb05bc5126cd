// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "ovimap/semantics/words/concepts.h"

namespace ovimap {

/// What a recognizer tells of the objects of a map.
struct SeenThings {
  std::vector<std::string>
      words;                   ///< of each thing that it knows, separated by |; none: no recognizer
  Eigen::MatrixXf log_ratios;  ///< [objects, things] as things_of() gives them; 0: it did not look
};

/// Takes what a recognizer tells by its own names to any text, by what words mean: a screen is what
/// it calls a monitor, and a seat is a chair, a sofa or another seat. Immutable.
class NamedThings {
 public:
  /// `concepts` must outlive it.
  NamedThings(const Concepts& concepts, const SeenThings& seen);

  /// [objects] how much more probable what was seen is of what the text names than of other things,
  /// as logarithm; no rows where the recognizer knows nothing of it.
  Eigen::VectorXf log_ratios(std::string_view text) const;

 private:
  using Kinds = std::vector<Concepts::Kind>;
  /// Of something of these kinds, where the recognizer has a name for it; else no rows.
  Eigen::VectorXf of_named(const Kinds& kinds) const;

  const Concepts& concepts_;
  std::vector<Kinds> kinds_;   ///< of each thing that a recognizer knows
  Eigen::MatrixXf ratios_;     ///< [objects, things]
  Eigen::MatrixXf household_;  ///< [objects, household words] likelihood ratios; 1: not known
  std::vector<bool> known_;    ///< of each household word: whether the recognizer has a name for it
};

}  // namespace ovimap
