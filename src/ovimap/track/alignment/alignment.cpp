// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/alignment/alignment.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/config.h"
#include "ovimap/track/alignment/residuals.h"

namespace ovimap {

namespace {

constexpr double kLeastOverlap = 0.1;                            // of a start
constexpr double kSureAgreement = 0.8, kSureCorrelation = 0.93;  // no other start need be tried
constexpr double kTexture = 6;                                   // grey levels; less says nothing
constexpr int kLeastIterations = 8;  // at most so many at least; still ones end a level before
constexpr double kStill = 1e-4;      // metres and radians: steps smaller than this end a level

MotionPrior prior_at(const Pose& present, const Pose& predicted,
                     const FrameAlignmentConfig& config) {
  MotionPrior prior;
  const double by_metre = 1 / (config.prior_sigma_m * config.prior_sigma_m),
               by_radian = 1 / (config.prior_sigma_rad * config.prior_sigma_rad);
  prior.information.diagonal() << by_metre, by_metre, by_metre, by_radian, by_radian, by_radian;
  prior.remaining = motion_of(predicted * present.inverse());
  return prior;
}

int iterations_of(std::size_t level, std::size_t levels, const FrameAlignmentConfig& config) {
  return std::max(kLeastIterations, config.max_iterations >> (levels - 1 - level));
}

double correlation(const ResidualSums& sums) {
  const double n = sums.photometric_count;
  if (n < 50) return 0;
  const double covariance = sums.products / n - sums.frame_sum / n * (sums.reference_sum / n);
  const double frame = sums.frame_squares / n - (sums.frame_sum / n) * (sums.frame_sum / n);
  const double reference =
      sums.reference_squares / n - (sums.reference_sum / n) * (sums.reference_sum / n);
  return frame > 0 && reference > 0 ? covariance / std::sqrt(frame * reference) : 0;
}

AlignmentQuality quality_of(const ResidualSums& sums) {
  AlignmentQuality quality;
  if (sums.points > 0) quality.overlap = sums.seen / sums.points;
  if (sums.measured > 0) quality.agreement = sums.agreeing / sums.measured;
  quality.correlation = correlation(sums);
  if (const double n = sums.photometric_count; n > 0)
    quality.texture = std::sqrt(std::max(
        0., sums.reference_squares / n - (sums.reference_sum / n) * (sums.reference_sum / n)));
  const double residuals = sums.measured + sums.photometric_count;
  if (residuals > 0) quality.cost = sums.cost / residuals;
  return quality;
}

/// Of a level's residuals, those that err independently: a coarse pixel stands for four finer ones.
double independent_share(std::size_t level, const FrameAlignmentConfig& config) {
  const auto halvings = static_cast<double>(std::max(level, kSurfaceLevel) - kSurfaceLevel);
  return std::min(1., config.independent_share * std::pow(4, halvings));
}

/// The steps of one level; `share` of its residuals are independent.
void align_level(const ReferenceLevel& reference, const TrackLevel& frame, const Pose& predicted,
                 float lever_m, int iterations, double share, const FrameAlignmentConfig& config,
                 ResidualScale& scale, Alignment& alignment) {
  const double min_information = 1 / (config.degenerate_sigma_m * config.degenerate_sigma_m);
  for (int i = 0; i < iterations; ++i) {
    const ResidualSums sums =
        sum_residuals(reference, frame, alignment.reference_from_frame, scale, config, true);
    alignment.information = share * sums.h;
    const MotionStep step = solve_step(share * sums.h, share * sums.b,
                                       prior_at(alignment.reference_from_frame, predicted, config),
                                       lever_m, min_information);
    alignment.degenerate = step.degenerate;
    alignment.reference_from_frame = small_motion(step.motion) * alignment.reference_from_frame;
    scale = sums.next_scale(scale);
    if (step.motion.head<3>().norm() < kStill && step.motion.tail<3>().norm() < kStill) break;
  }
}

}  // namespace

void list_fields(FrameAlignmentConfig& config, ConfigFields& fields) {
  fields.group("noise", [&](ConfigFields& f) { list_fields(config.noise, f); });
  fields.add("model_sigma_m", config.model_sigma_m, 0.0001f, 0.1f,
             "standard deviation of the map's surface, metres");
  fields.add("photometric_weight", config.photometric_weight, 0.f, 100.f,
             "weight of a pixel's intensity beside its depth; 0: depth alone");
  fields.add("independent_share", config.independent_share, 1e-5f, 1.f,
             "share of all residuals that err independently");
  fields.add("prior_sigma_m", config.prior_sigma_m, 1e-4f, 10.f,
             "standard deviation of the predicted motion, metres");
  fields.add("prior_sigma_rad", config.prior_sigma_rad, 1e-4f, 10.f,
             "standard deviation of the predicted rotation, radians");
  fields.add("degenerate_sigma_m", config.degenerate_sigma_m, 1e-4f, 10.f,
             "directions that the data know less well are left to the prediction, metres");
  fields.add("max_iterations", config.max_iterations, 1, 100,
             "steps at the coarsest level; finer levels take fewer");
}

bool beyond_doubt(const AlignmentQuality& quality) {
  return quality.agreement >= kSureAgreement &&
         (quality.texture < kTexture || quality.correlation >= kSureCorrelation);
}

Alignment align(const Reference& reference, const TrackPyramid& frame, const Pose& predicted,
                const FrameAlignmentConfig& config, std::size_t finest) {
  OVIMAP_ASSERT(reference.levels.size() == frame.size());
  Alignment alignment;
  alignment.reference_from_frame = predicted;
  ResidualScale scale;
  const std::size_t levels = frame.size();
  for (std::size_t level = levels; level-- > finest;) {
    if (reference.levels[level].points.empty()) continue;
    scale.reach = 1 + static_cast<float>(level);
    align_level(reference.levels[level], frame[level], predicted, reference.median_depth_m,
                iterations_of(level, levels, config), independent_share(level, config), config,
                scale, alignment);
  }
  alignment.reference_from_frame.linear() =
      Eigen::Quaterniond(alignment.reference_from_frame.linear()).normalized().matrix();
  alignment.quality =
      judge(reference, frame, alignment.reference_from_frame, config, kSurfaceLevel);
  return alignment;
}

std::optional<Alignment> align_best(const Reference& reference, const TrackPyramid& frame,
                                    const std::vector<Pose>& reference_from_frame,
                                    const FrameAlignmentConfig& config) {
  if (reference.levels.size() != frame.size()) return std::nullopt;  // of a camera unlike this one
  const std::size_t level = std::min(kSurfaceLevel + 1, frame.size() - 1);
  std::vector<std::pair<double, const Pose*>> ranked;
  for (const Pose& start : reference_from_frame) {
    const AlignmentQuality quality = judge(reference, frame, start, config, level);
    if (quality.overlap >= kLeastOverlap) ranked.emplace_back(quality.cost, &start);
  }
  std::sort(ranked.begin(), ranked.end());
  std::optional<Alignment> best;
  for (const auto& [cost, start] : ranked) {
    Alignment alignment = align(reference, frame, *start, config);
    const bool sure = beyond_doubt(alignment.quality);
    if (!best || alignment.quality.cost < best->quality.cost) best = std::move(alignment);
    if (sure) break;
  }
  return best;
}

AlignmentQuality judge(const Reference& reference, const TrackPyramid& frame,
                       const Pose& reference_from_frame, const FrameAlignmentConfig& config,
                       std::size_t level) {
  ResidualScale scale;
  scale.geometric = 1;
  return quality_of(sum_residuals(reference.levels[level], frame[level], reference_from_frame,
                                  scale, config, false));
}

}  // namespace ovimap
