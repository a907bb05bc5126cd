// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/alignment/residuals.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/track/alignment/point_residuals.h"

namespace ovimap {

namespace {

constexpr std::size_t kEightsPerTask = 128;  // fixed, so that sums do not depend on threads
constexpr float kFreedom = 5;                // degrees of freedom of Student's t
constexpr float kAgree_sigmas = 3;
constexpr float kElsewhere = 2 * kAgree_sigmas;  // another surface: as bad as can be, but bounded

OVIMAP_INLINE Floats t_weight(Floats normalised) {
  return (kFreedom + 1) / (kFreedom + normalised * normalised);
}

/// Student's t makes a residual cost (kFreedom + 1) / 2 * log(t_factor).
OVIMAP_INLINE Floats t_factor(Floats normalised) {
  return 1.f + normalised * normalised / kFreedom;
}

double t_cost(double sum_of_logs) {
  return (kFreedom + 1) / 2 * sum_of_logs;
}

/// The sum of the logarithms of factors from 1 on: that of their product, taken before it is too
/// large for a float.
class LogSum {
 public:
  OVIMAP_INLINE void add(Floats factors) {
    product_ *= factors;
    if (any(product_ > kLarge)) sum();
  }
  double sum() {
    for (int lane = 0; lane < kLanes; ++lane) sum_ += std::log(static_cast<double>(product_[lane]));
    product_ = broadcast(1);
    return sum_;
  }

 private:
  static constexpr float kLarge = 1e19f;  // its square is still a float
  Floats product_ = broadcast(1);
  double sum_ = 0;
};

/// One row of the Jacobian of eight residuals.
using EightRows = Floats[6];

/// What one task adds up, in single precision; of H the upper triangle alone.
struct TaskSums {
  Floats h[21] = {}, b[6] = {};
  Floats geometric_squares = {}, photometric_squares = {};
  Floats frame_sum = {}, frame_squares = {}, reference_sum = {}, reference_squares = {},
         products = {};
  int seen = 0, measured = 0, agreeing = 0, near = 0, textured = 0;
  LogSum geometric, photometric;

  OVIMAP_INLINE void add(const EightRows& j, Floats weight, Floats residual) {
    int k = 0;
    for (int row = 0; row < 6; ++row) {
      const Floats weighted = weight * j[row];
      b[row] -= weighted * residual;
      for (int column = row; column < 6; ++column) h[k++] += weighted * j[column];
    }
  }
};

/// The frame's point off the reference's plane: n . (motion * hit - point).
OVIMAP_INLINE void add_geometric(const EightPoints& points, const EightResiduals& at,
                                 const ResidualScale& scale, bool derivatives, TaskSums& task) {
  const Floats residual = at.distance_m / at.sigma_m;
  const Floats normalised = at.near ? residual / scale.geometric : Floats{};
  const Floats weight = at.near ? t_weight(normalised) : Floats{};
  task.geometric_squares += weight * residual * residual;
  if (!derivatives) return task.geometric.add(t_factor(normalised));
  const EightVectors normal = normals_of(points), turn = cross(at.hit, normal);
  const Floats unit = 1.f / (at.sigma_m * scale.geometric);
  const EightRows j = {normal.x * unit, normal.y * unit, normal.z * unit,
                       turn.x * unit,   turn.y * unit,   turn.z * unit};
  task.add(j, weight, normalised);
}

/// The frame's intensity where the point projects: the frame moves one way, the point, seen from
/// it, the other.
OVIMAP_INLINE void add_photometric(const EightPoints& points, const PinholeCamera& camera,
                                   const EightResiduals& at, Ints compared,
                                   const ResidualScale& scale, float emphasis, bool derivatives,
                                   TaskSums& task) {
  const Floats residual = scale.gain * at.intensity + scale.bias - load(points.intensity);
  const Floats normalised = compared ? residual / scale.photometric : Floats{};
  const Floats weight = compared ? t_weight(normalised) : Floats{};
  task.photometric_squares += weight * residual * residual;
  if (!derivatives) return task.photometric.add(t_factor(normalised));
  const EightVectors point = points_of(points);
  const Floats inverse = 1.f / point.z;
  const Floats du = load(points.gradient_x) * camera.fx * inverse,
               dv = load(points.gradient_y) * camera.fy * inverse;
  const EightVectors by_point = {du, dv, -(du * point.x + dv * point.y) * inverse};
  const EightVectors turn = cross(point, by_point);
  const float unit = -1 / scale.photometric;
  const EightRows j = {by_point.x * unit, by_point.y * unit, by_point.z * unit,
                       turn.x * unit,     turn.y * unit,     turn.z * unit};
  task.add(j, weight * emphasis, normalised);
}

OVIMAP_INLINE void add_statistics(const EightPoints& points, const EightResiduals& at,
                                  Ints compared, TaskSums& task) {
  const Floats frame = compared ? at.intensity : Floats{},
               reference = compared ? load(points.intensity) : Floats{};
  task.frame_sum += frame, task.frame_squares += frame * frame;
  task.reference_sum += reference, task.reference_squares += reference * reference;
  task.products += frame * reference;
}

/// The lanes of the eight from `begin` on that are before `end`.
OVIMAP_INLINE Ints lanes_before(std::size_t begin, std::size_t end) {
  return lane_numbers() < static_cast<int>(std::min<std::size_t>(kLanes, end - begin));
}

OVIMAP_VECTORIZE void sum_range(const ReferenceLevel& reference, std::size_t begin, std::size_t end,
                                const ResidualView& view, const ResidualScale& scale,
                                bool derivatives, TaskSums& task) {
  const float emphasis = view.config.photometric_weight;
  for (std::size_t i = begin; i < end; ++i) {
    const EightPoints& points = reference.points.eights()[i];
    const EightResiduals at =
        residuals_of(points, lanes_before(i * kLanes, reference.points.size()), view);
    const Ints agreeing = at.near & (magnitude(at.distance_m) < kAgree_sigmas * at.sigma_m);
    const Ints compared = at.textured & ~(at.measured & ~at.near);
    task.seen += count_of(at.seen), task.measured += count_of(at.measured);
    task.near += count_of(at.near), task.agreeing += count_of(agreeing);
    task.textured += count_of(compared);
    add_geometric(points, at, scale, derivatives, task);
    add_statistics(points, at, compared, task);
    if (emphasis > 0)
      add_photometric(points, reference.camera, at, compared, scale, emphasis, derivatives, task);
  }
}

OVIMAP_VECTORIZE void store_range(const ReferencePoints& points, const ResidualView& view,
                                  std::vector<PointResidual>& residuals) {
  for (std::size_t begin = 0; begin < points.size(); begin += kLanes) {
    const EightResiduals at =
        residuals_of(points.eights()[begin / kLanes], lanes_before(begin, points.size()), view);
    const std::size_t end = std::min(begin + kLanes, points.size());
    for (std::size_t i = begin; i < end; ++i) {
      const auto lane = static_cast<int>(i - begin);
      residuals[i] = {at.seen[lane] != 0,  at.measured[lane] != 0,
                      at.near[lane] != 0,  at.textured[lane] != 0,
                      at.distance_m[lane], at.sigma_m[lane],
                      at.intensity[lane],  {at.hit.x[lane], at.hit.y[lane], at.hit.z[lane]}};
    }
  }
}

ResidualSums residual_sums(TaskSums& task, float emphasis, bool derivatives) {
  ResidualSums sums;
  int k = 0;
  for (int row = 0; row < 6; ++row) {
    sums.b[row] = sum_of(task.b[row]);
    for (int column = row; column < 6; ++column, ++k)
      sums.h(row, column) = sums.h(column, row) = sum_of(task.h[k]);
  }
  sums.seen = task.seen, sums.measured = task.measured, sums.agreeing = task.agreeing;
  sums.geometric_squares = sum_of(task.geometric_squares), sums.geometric_weights = task.near;
  sums.photometric_squares = sum_of(task.photometric_squares);
  if (emphasis > 0) sums.photometric_count = task.textured;
  sums.frame_sum = sum_of(task.frame_sum), sums.frame_squares = sum_of(task.frame_squares);
  sums.reference_sum = sum_of(task.reference_sum);
  sums.reference_squares = sum_of(task.reference_squares), sums.products = sum_of(task.products);
  const double elsewhere =
      (task.measured - task.near) * std::log1p(kElsewhere * kElsewhere / kFreedom);
  if (!derivatives)
    sums.cost = t_cost(task.geometric.sum() + elsewhere + emphasis * task.photometric.sum());
  return sums;
}

}  // namespace

ResidualSums& ResidualSums::operator+=(const ResidualSums& other) {
  h += other.h, b += other.b;
  points += other.points, seen += other.seen, measured += other.measured;
  agreeing += other.agreeing;
  geometric_squares += other.geometric_squares, geometric_weights += other.geometric_weights;
  photometric_squares += other.photometric_squares, photometric_count += other.photometric_count;
  cost += other.cost;
  frame_sum += other.frame_sum, frame_squares += other.frame_squares;
  reference_sum += other.reference_sum, reference_squares += other.reference_squares;
  products += other.products;
  return *this;
}

ResidualScale ResidualSums::next_scale(const ResidualScale& present) const {
  ResidualScale next = present;
  if (geometric_weights > 0)
    next.geometric = std::clamp(
        static_cast<float>(std::sqrt(geometric_squares / geometric_weights)), 0.5f, 10.f);
  if (photometric_count < 50) return next;
  next.photometric =
      std::clamp(static_cast<float>(std::sqrt(photometric_squares / photometric_count)), 2.f, 40.f);
  const double n = photometric_count;
  const double frame_variance = frame_squares / n - (frame_sum / n) * (frame_sum / n);
  const double reference_variance =
      reference_squares / n - (reference_sum / n) * (reference_sum / n);
  if (frame_variance > 25 && reference_variance > 25)
    next.gain =
        std::clamp(static_cast<float>(std::sqrt(reference_variance / frame_variance)), 0.7f, 1.4f);
  next.bias = static_cast<float>(reference_sum / n - next.gain * frame_sum / n);
  return next;
}

ResidualSums sum_residuals(const ReferenceLevel& reference, const TrackLevel& frame,
                           const Pose& reference_from_frame, const ResidualScale& scale,
                           const FrameAlignmentConfig& config, bool derivatives) {
  const ResidualView view(frame, reference_from_frame, config, scale.reach);
  const std::size_t eights = reference.points.eights().size();
  std::vector<ResidualSums> parts((eights + kEightsPerTask - 1) / kEightsPerTask);
  parallel_for_ranges(eights, kEightsPerTask, [&](std::size_t begin, std::size_t end) {
    TaskSums task;
    sum_range(reference, begin, end, view, scale, derivatives, task);
    parts[begin / kEightsPerTask] = residual_sums(task, config.photometric_weight, derivatives);
  });
  ResidualSums sums;
  for (const ResidualSums& part : parts) sums += part;
  sums.points = static_cast<double>(reference.points.size());
  return sums;
}

std::vector<PointResidual> point_residuals(const ReferenceLevel& reference, const TrackLevel& frame,
                                           const Pose& reference_from_frame,
                                           const FrameAlignmentConfig& config, float reach) {
  std::vector<PointResidual> residuals(reference.points.size());
  store_range(reference.points, ResidualView(frame, reference_from_frame, config, reach),
              residuals);
  return residuals;
}

}  // namespace ovimap
