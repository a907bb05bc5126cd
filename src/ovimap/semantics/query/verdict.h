// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "ovimap/semantics/query/search_index.h"

namespace ovimap {

class ConfigFields;

enum class Verdict { kFound, kNotInMap };

/// "found" or "not_in_map", as the program prints it.
const char* verdict_name(Verdict verdict);

struct VerdictConfig {
  float false_positive_rate = 0.05f;  ///< share of absent things that may be answered "found"
  float spread_shrinkage = 0.5f;      ///< pull of an object's score variance to the map's median
  float common_quantile = 0.25f;      ///< a text is near everything when this quantile of objects
  float common_level = 0.95f;         ///< ... scores above this quantile of the vocabulary's
  float fit_low = 0.1f;               ///< the null distribution is fitted between these quantiles
  float fit_high = 0.6f;              ///< ... of the vocabulary's best scores
  int max_sample_objects = 2048;      ///< objects from which spread and overlap are estimated
  int min_references = 20;            ///< fewer reference vectors give no verdict
};
void list_fields(VerdictConfig& config, ConfigFields& fields);

/// How alike the objects of a map are in the eyes of the encoder: scores of unrelated things on
/// them are a part that all objects share and a part of their own.
struct ObjectLikeness {
  double shared = 0;     ///< share of the variance that is common to all, in [0, 1)
  double own_parts = 1;  ///< independent own parts among the objects, at least 1
};

/// The best score in a map of a thing that is not in it:
///     location + scale * (sqrt(shared) * g + sqrt(1 - shared) * max of own_parts e_i)
/// with g, e_i independent standard normal.
struct NullDistribution {
  double location = 0, scale = 1;
  ObjectLikeness likeness;
  double present_share = 0;  ///< of the vocabulary: words above what this distribution explains

  /// Chance that an absent thing's best score reaches `score`.
  double p_value(double score) const;
  /// The score whose p-value is `p`, in (0, 1).
  double score_at(double p) const;
};

/// Fits the null distribution to the best scores of a vocabulary of which an unknown share is in
/// the map (Efron 2004, "Large-scale simultaneous hypothesis testing": an empirical null is fitted
/// to the bulk, where what is present hardly counts). At least one score.
NullDistribution fit_null(std::vector<double> best_scores, const ObjectLikeness& likeness,
                          const VerdictConfig& config);

/// Turns cosines into comparable scores and these into verdicts, for one map and one encoder.
/// docs/query.md explains and measures it. Immutable.
class ScoreCalibration {
 public:
  /// `references` [m, d]: embeddings of unrelated things, rows of length 1, m >= min_references.
  /// own_objects[j] is the position of the object that reference j itself is, kNoObject when it is
  /// none (or the span is empty): its match with itself tells nothing.
  ScoreCalibration(const SearchIndex& index, const Embeddings& references,
                   const VerdictConfig& config, std::span<const std::size_t> own_objects = {});

  static constexpr std::size_t kNoObject = static_cast<std::size_t>(-1);

  /// [objects] cosines of one query -> by how many standard deviations each is above what
  /// unrelated things score on that object, less what a query that is near everything has too much.
  Eigen::VectorXf standard_scores(const Eigen::VectorXf& cosines) const;

  const NullDistribution& null_distribution() const { return null_; }

 private:
  struct ScoreSpread;
  /// The best standardised score of each reference; fills means_ and spreads_ on the way.
  std::vector<float> best_scores(const SearchIndex& index, const std::vector<std::size_t>& embedded,
                                 const Embeddings& references, const ScoreSpread& spread,
                                 std::span<const std::size_t> own_objects);

  VerdictConfig config_;
  std::vector<std::size_t> sample_;  ///< positions of some objects with embedding
  Eigen::VectorXf means_, spreads_;  ///< [objects] of the references' cosines
  float common_limit_ = 0;           ///< what a text may have in common with everything
  float common_weight_ = 0;          ///< less in a map of objects that are all alike
  NullDistribution null_;
};

/// Chance in [0, 1] that a match with this p-value is one, from even odds: the bound of Sellke,
/// Bayarri and Berger (2001), "Calibration of p values for testing precise null hypotheses", below
/// p = 1/e, and its continuation by a line to 0 at p = 1.
double match_probability(double p_value);

}  // namespace ovimap
