// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

constexpr std::size_t kObjectsPerBlock = 256;  // of a product with all references: fits the cache
constexpr double kSmallestSpread = 1e-6;       // of cosines: below it all numbers are rounding
constexpr double kMostShared = 1.0 - 1e-6;     // objects are never copies to the last bit

// Numbers of the fit and of its integrals, far finer than what is fitted.
constexpr int kFitQuantiles = 11;
constexpr int kMaxFitRounds = 50;     // it settles after about five
constexpr double kFitSettled = 1e-6;  // change of the present share that ends it
constexpr int kIntegralPoints = 61;
constexpr double kIntegralEnd = 6.0;  // standard deviations
constexpr double kFar = 40.0;         // standard deviations beyond all scores
constexpr int kBisections = 60;

double normal_below(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

/// 1 - P(sqrt(shared) * g + sqrt(1 - shared) * max of own_parts e_i < x), by the trapezoid rule
/// over g; small results keep their digits.
double null_above(double x, const ObjectLikeness& likeness) {
  const double step = 2.0 * kIntegralEnd / (kIntegralPoints - 1);
  const double common = std::sqrt(likeness.shared), own = std::sqrt(1.0 - likeness.shared);
  double sum = 0, weights = 0;
  for (int i = 0; i < kIntegralPoints; ++i) {
    const double g = -kIntegralEnd + step * i;
    const double weight = std::exp(-0.5 * g * g);
    const double above = normal_below((common * g - x) / own);
    sum += weight * -std::expm1(likeness.own_parts * std::log1p(-above));
    weights += weight;
  }
  return sum / weights;
}

/// The x with null_above(x) = p.
double null_quantile(double p, const ObjectLikeness& likeness) {
  double low = -kFar, high = kFar;
  for (int round = 0; round < kBisections; ++round) {
    const double middle = 0.5 * (low + high);
    (null_above(middle, likeness) > p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Linear interpolation between order statistics. `sorted` is not empty.
template <class Number>
Number quantile_of_sorted(const std::vector<Number>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const auto weight = static_cast<Number>(at - static_cast<double>(below));
  return sorted[below] + weight * (sorted[above] - sorted[below]);
}

template <class Number>
Number quantile(std::vector<Number> values, double share) {
  // Puts the two order statistics in their places; the rest needs no order.
  const auto below = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + below, values.end());
  if (below + 1 < static_cast<std::ptrdiff_t>(values.size()))
    std::iter_swap(values.begin() + below + 1,
                   std::min_element(values.begin() + below + 1, values.end()));
  return quantile_of_sorted(values, share);
}

/// Least-squares line y = location + scale * x.
void fit_line(const std::vector<double>& x, const std::vector<double>& y, double& location,
              double& scale) {
  const auto count = static_cast<double>(x.size());
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += x[i];
    sy += y[i];
    sxx += x[i] * x[i];
    sxy += x[i] * y[i];
  }
  scale = (count * sxy - sx * sy) / (count * sxx - sx * sx);
  location = (sy - scale * sx) / count;
}

std::vector<std::size_t> embedded_objects(const SearchIndex& index) {
  std::vector<std::size_t> positions;
  for (std::size_t i = 0; i < index.size(); ++i)
    if (index.has_embedding(i)) positions.push_back(i);
  return positions;
}

std::vector<std::size_t> every_nth(const std::vector<std::size_t>& positions, std::size_t most) {
  if (positions.size() <= most) return positions;
  std::vector<std::size_t> some(most);
  for (std::size_t i = 0; i < most; ++i) some[i] = positions[i * positions.size() / most];
  return some;
}

/// [positions, references]
Eigen::MatrixXf cosines_of(const SearchIndex& index, std::span<const std::size_t> positions,
                           const Embeddings& references) {
  Embeddings rows(static_cast<Eigen::Index>(positions.size()), references.cols());
  for (std::size_t i = 0; i < positions.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) =
        index.embeddings().row(static_cast<Eigen::Index>(positions[i]));
  return rows * references.transpose();
}

double row_variance(const Eigen::MatrixXf& scores, Eigen::Index row) {
  return double{(scores.row(row).array() - scores.row(row).mean()).square().mean()};
}

double median_variance(const Eigen::MatrixXf& scores) {
  std::vector<double> variances(static_cast<std::size_t>(scores.rows()));
  for (std::size_t i = 0; i < variances.size(); ++i)
    variances[i] = row_variance(scores, static_cast<Eigen::Index>(i));
  return quantile(std::move(variances), 0.5);
}

/// The quantile of each column.
std::vector<float> column_quantiles(const Eigen::MatrixXf& scores, double share) {
  std::vector<float> quantiles(static_cast<std::size_t>(scores.cols()));
  for (std::size_t j = 0; j < quantiles.size(); ++j) {
    const auto column = scores.col(static_cast<Eigen::Index>(j));
    quantiles[j] = quantile(std::vector<float>(column.begin(), column.end()), share);
  }
  return quantiles;
}

/// Lowers the score of reference j on its own object below every other.
void leave_out_own(Eigen::MatrixXf& scores, std::span<const std::size_t> block,
                   std::span<const std::size_t> own_objects) {
  for (std::size_t j = 0; j < own_objects.size(); ++j) {
    const auto at = std::lower_bound(block.begin(), block.end(), own_objects[j]);
    if (at != block.end() && *at == own_objects[j])
      scores(at - block.begin(), static_cast<Eigen::Index>(j)) =
          std::numeric_limits<float>::lowest();
  }
}

/// How many independent rows `rows` of length 1 (or 0) are worth: the participation ratio of their
/// products.
double effective_rows(const Eigen::MatrixXf& rows) {
  const Eigen::MatrixXf gram = rows.rows() < rows.cols() ? Eigen::MatrixXf(rows * rows.transpose())
                                                         : Eigen::MatrixXf(rows.transpose() * rows);
  const auto count = static_cast<double>(rows.rows());
  return std::clamp(count * count / std::max(double{gram.squaredNorm()}, 1.0), 1.0, count);
}

/// `rows` [objects, references]: scores without their means, of length 1 a row.
ObjectLikeness likeness_of(Eigen::MatrixXf rows) {
  const auto count = static_cast<double>(rows.rows());
  ObjectLikeness likeness;
  if (rows.rows() < 2) return likeness;
  const Eigen::RowVectorXf sum = rows.colwise().sum();
  const double mean_correlation = (double{sum.squaredNorm()} - count) / (count * (count - 1.0));
  likeness.shared = std::clamp(mean_correlation, 0.0, kMostShared);
  const Eigen::RowVectorXf factor = sum.normalized();
  rows -= (rows * factor.transpose()) * factor;
  rows.rowwise().normalize();
  likeness.own_parts = effective_rows(rows);
  return likeness;
}

Eigen::MatrixXf centred_rows(Eigen::MatrixXf scores) {
  scores.colwise() -= scores.rowwise().mean().eval();
  scores.rowwise().normalize();
  return scores;
}

}  // namespace

/// How an object's cosines with the references become comparable with those of other objects.
struct ScoreCalibration::ScoreSpread {
  double median_variance, shrinkage;

  /// Scales one row of `scores`; returns the mean and the deviation it had.
  std::pair<float, float> standardise(Eigen::MatrixXf& scores, Eigen::Index row) const {
    const float mean = scores.row(row).mean();
    const double variance =
        (1.0 - shrinkage) * row_variance(scores, row) + shrinkage * median_variance;
    const auto deviation = static_cast<float>(std::max(std::sqrt(variance), kSmallestSpread));
    scores.row(row).array() = (scores.row(row).array() - mean) / deviation;
    return {mean, deviation};
  }
};

void list_fields(VerdictConfig& config, ConfigFields& fields) {
  constexpr int kMost = 1000000;
  fields.add("false_positive_rate", config.false_positive_rate, 1e-6f, 0.5f,
             "share of absent things that may be answered \"found\"");
  fields.add("spread_shrinkage", config.spread_shrinkage, 0.f, 1.f,
             "pull of an object's score variance to the map's median: 0 none, 1 all the same");
  fields.add("common_quantile", config.common_quantile, 0.f, 1.f,
             "a text is near everything when this quantile of the objects");
  fields.add("common_level", config.common_level, 0.f, 1.f,
             "... scores above this quantile of the vocabulary's words");
  fields.add("fit_low", config.fit_low, 0.01f, 0.5f,
             "the null distribution is fitted from this quantile of the vocabulary's best scores");
  fields.add("fit_high", config.fit_high, 0.51f, 0.99f, "... to this one");
  fields.add("max_sample_objects", config.max_sample_objects, 1, kMost,
             "objects from which spread and overlap are estimated");
  fields.add("min_references", config.min_references, 5, kMost,
             "fewer reference vectors give no verdict");
}

const char* verdict_name(Verdict verdict) {
  return verdict == Verdict::kFound ? "found" : "not_in_map";
}

double NullDistribution::p_value(double score) const {
  return null_above((score - location) / scale, likeness);
}

double NullDistribution::score_at(double p) const {
  return location + scale * null_quantile(p, likeness);
}

NullDistribution fit_null(std::vector<double> best_scores, const ObjectLikeness& likeness,
                          const VerdictConfig& config) {
  OVIMAP_ASSERT(!best_scores.empty());
  std::sort(best_scores.begin(), best_scores.end());
  NullDistribution null;
  null.likeness = likeness;
  const double rate = config.false_positive_rate;
  const double cut = null_quantile(rate, likeness);
  std::vector<double> shares(kFitQuantiles), expected(kFitQuantiles), observed(kFitQuantiles);
  for (int i = 0; i < kFitQuantiles; ++i) {
    const auto k = static_cast<std::size_t>(i);
    shares[k] = config.fit_low + (config.fit_high - config.fit_low) * i / (kFitQuantiles - 1);
    expected[k] = null_quantile(1.0 - shares[k], likeness);
  }
  for (int round = 0; round < kMaxFitRounds; ++round) {
    // Words in the map score high: the null's quantile q is the observed one at q * (1 - present).
    for (std::size_t k = 0; k < shares.size(); ++k)
      observed[k] = quantile_of_sorted(best_scores, shares[k] * (1.0 - null.present_share));
    fit_line(expected, observed, null.location, null.scale);
    null.scale = std::max(null.scale, kSmallestSpread);
    const double level = null.location + null.scale * cut;
    const auto above =
        best_scores.end() - std::lower_bound(best_scores.begin(), best_scores.end(), level);
    const double share = static_cast<double>(above) / static_cast<double>(best_scores.size());
    const double present = std::max(0.0, (share - rate) / (1.0 - rate));
    const bool settled = std::abs(present - null.present_share) < kFitSettled;
    null.present_share = present;
    if (settled) break;
  }
  return null;
}

ScoreCalibration::ScoreCalibration(const SearchIndex& index, const Embeddings& references,
                                   const VerdictConfig& config,
                                   std::span<const std::size_t> own_objects)
    : config_(config),
      means_(Eigen::VectorXf::Zero(static_cast<Eigen::Index>(index.size()))),
      spreads_(Eigen::VectorXf::Ones(static_cast<Eigen::Index>(index.size()))) {
  OVIMAP_ASSERT(index.embedded() > 0 && references.rows() >= config.min_references);
  const std::vector<std::size_t> embedded = embedded_objects(index);
  sample_ = every_nth(embedded, static_cast<std::size_t>(config.max_sample_objects));

  Eigen::MatrixXf sample_scores = cosines_of(index, sample_, references);
  const ScoreSpread spread{median_variance(sample_scores), config.spread_shrinkage};
  for (Eigen::Index row = 0; row < sample_scores.rows(); ++row)
    spread.standardise(sample_scores, row);
  const Eigen::MatrixXf centred = centred_rows(sample_scores);
  common_weight_ = static_cast<float>(1.0 - 1.0 / effective_rows(centred));
  const std::vector<float> common = column_quantiles(sample_scores, config.common_quantile);
  common_limit_ = quantile(common, config.common_level);

  const std::vector<float> best = best_scores(index, embedded, references, spread, own_objects);
  std::vector<double> corrected(best.size());
  for (std::size_t j = 0; j < best.size(); ++j)
    corrected[j] = best[j] - common_weight_ * std::max(0.f, common[j] - common_limit_);
  null_ = fit_null(std::move(corrected), likeness_of(centred), config);
}

std::vector<float> ScoreCalibration::best_scores(const SearchIndex& index,
                                                 const std::vector<std::size_t>& embedded,
                                                 const Embeddings& references,
                                                 const ScoreSpread& spread,
                                                 std::span<const std::size_t> own_objects) {
  const auto reference_count = static_cast<std::size_t>(references.rows());
  std::vector<float> best(reference_count, std::numeric_limits<float>::lowest());
  std::mutex merging;  // the largest of several numbers does not depend on their order
  parallel_for_ranges(embedded.size(), kObjectsPerBlock, [&](std::size_t begin, std::size_t end) {
    const std::span<const std::size_t> block(embedded.data() + begin, end - begin);
    Eigen::MatrixXf scores = cosines_of(index, block, references);
    for (std::size_t i = 0; i < block.size(); ++i) {
      const auto [mean, deviation] = spread.standardise(scores, static_cast<Eigen::Index>(i));
      means_[static_cast<Eigen::Index>(block[i])] = mean;
      spreads_[static_cast<Eigen::Index>(block[i])] = deviation;
    }
    leave_out_own(scores, block, own_objects);
    const Eigen::VectorXf block_best = scores.colwise().maxCoeff().transpose();
    const std::lock_guard lock(merging);
    for (std::size_t j = 0; j < reference_count; ++j)
      best[j] = std::max(best[j], block_best[static_cast<Eigen::Index>(j)]);
  });
  return best;
}

Eigen::VectorXf ScoreCalibration::standard_scores(const Eigen::VectorXf& cosines) const {
  OVIMAP_ASSERT(cosines.size() == means_.size());
  Eigen::VectorXf scores = (cosines - means_).cwiseQuotient(spreads_);
  std::vector<float> some(sample_.size());
  for (std::size_t i = 0; i < sample_.size(); ++i)
    some[i] = scores[static_cast<Eigen::Index>(sample_[i])];
  const float common = quantile(std::move(some), config_.common_quantile);
  scores.array() -= common_weight_ * std::max(0.f, common - common_limit_);
  return scores;
}

double match_probability(double p_value) {
  const double p = std::clamp(p_value, 0.0, 1.0);
  constexpr double kTurn = 1.0 / std::numbers::e;
  if (p == 0.0) return 1.0;
  if (p < kTurn) return 1.0 / (1.0 - std::numbers::e * p * std::log(p));
  return 0.5 * (1.0 - p) / (1.0 - kTurn);
}

}  // namespace ovimap
