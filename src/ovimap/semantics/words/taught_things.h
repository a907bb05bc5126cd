// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "ovimap/inference/encoders/image_text_encoder.h"
#include "ovimap/semantics/words/concepts.h"

namespace ovimap {

/// Things that people named, as examples of what their names mean.
struct TaughtThings {
  std::vector<std::string> names;
  Embeddings
      looks;  ///< [things, dimension], rows of length 1, by the encoder of the map in question
};

/// What examples say of the objects of a map: an object that looks like the thing that somebody
/// called a vase is rather a vase (docs/query.md). Named objects of the map are examples
/// themselves. Immutable.
class TaughtNames {
 public:
  TaughtNames() = default;
  /// `concepts` must outlive it. `own`: the objects of the map, their names empty where nobody gave
  /// one, and their looks zero where they have none. `things`: of other maps; none: the map's own
  /// names alone. Throws Error where the looks are not of one length.
  TaughtNames(const Concepts& concepts, const TaughtThings& own, const TaughtThings& things);

  /// [objects] how much more probable it is to look like that for what the text names than for
  /// other things, as logarithm; no rows where nobody named such a thing. An object that a person
  /// gave the name has kCertain.
  Eigen::VectorXf log_ratios(std::string_view text) const;

  static constexpr float kCertain = std::numeric_limits<float>::max();

  struct Likeness {
    std::string name;
    float log_ratio = 0;
  };
  /// The example that each object resembles most; empty where there are none.
  std::vector<Likeness> nearest() const;

 private:
  using Kinds = std::vector<Concepts::Kind>;
  /// Whether the example is one of what the text names. `whole`: its kinds are those of all its
  /// words.
  bool is_named(const std::string& text, const Kinds& kinds, bool whole, std::size_t example) const;

  const Concepts* concepts_ = nullptr;
  std::vector<std::string> names_, folded_;  ///< of each example, as it was given and in lower case
  std::vector<Kinds> kinds_;                 ///< of each example
  Eigen::MatrixXf ratios_;                   ///< [objects, examples]
};

}  // namespace ovimap
