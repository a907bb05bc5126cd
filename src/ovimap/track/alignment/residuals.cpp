// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/alignment/residuals.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"

namespace ovimap {

namespace {

constexpr std::size_t kPointsPerTask = 1024;  // fixed, so that sums do not depend on threads
constexpr float kFreedom = 5;                 // degrees of freedom of Student's t
constexpr float kAgree_sigmas = 3;
constexpr float kFar_m = 0.05f, kFarShare = 0.05f;  // farther off is another surface
constexpr float kMinCosine = 0.15f;

using Vector6f = Eigen::Matrix<float, 6, 1>;

}  // namespace

PointResidual residual_of(const ReferencePoint& point, const TrackLevel& frame,
                          const Eigen::Isometry3f& reference_from_frame,
                          const Eigen::Isometry3f& frame_from_reference,
                          const FrameAlignmentConfig& config, float reach) {
  PointResidual at;
  const Eigen::Vector3f in_frame = frame_from_reference * point.point;
  if (in_frame.z() <= 0.05f) return at;
  const Eigen::Vector2f pixel = frame.camera.project(in_frame);
  const auto width = static_cast<float>(frame.camera.width),
             height = static_cast<float>(frame.camera.height);
  if (!(pixel.x() > -0.5f && pixel.y() > -0.5f && pixel.x() < width - 0.5f &&
        pixel.y() < height - 0.5f))
    return at;
  const int x = static_cast<int>(pixel.x() + 0.5f), y = static_cast<int>(pixel.y() + 0.5f);
  at.seen = true;
  if (point.intensity >= 0) {
    at.intensity = intensity_at(frame.intensity, pixel.x(), pixel.y());
    at.textured = at.intensity >= 0;
  }
  const float inverse = frame.inverse_depth.row(y)[x];
  if (inverse == 0) return at;
  at.measured = true;
  const float depth = 1 / inverse;
  const Eigen::Vector3f ray =
      frame.camera.unproject(static_cast<float>(x), static_cast<float>(y), 1.f);
  at.hit = reference_from_frame * Eigen::Vector3f(depth * ray);
  at.distance_m = point.normal.dot(at.hit - point.point);
  const float cosine =
      std::max(kMinCosine, std::fabs(point.normal.dot(reference_from_frame.linear() * ray)));
  const float noise = config.noise.sigma_m(depth) * cosine;
  at.sigma_m = std::sqrt(noise * noise + config.model_sigma_m * config.model_sigma_m);
  at.near = std::fabs(depth - in_frame.z()) < reach * (kFar_m + kFarShare * depth);
  return at;
}

namespace {

/// Sums of one task, in single precision; only the upper triangle of H.
struct TaskSums {
  float h[21] = {}, b[6] = {};

  void add(const Vector6f& j, float weight, float residual) {
    int k = 0;
    for (int row = 0; row < 6; ++row) {
      const float weighted = weight * j[row];
      b[row] -= weighted * residual;
      for (int column = row; column < 6; ++column) h[k++] += weighted * j[column];
    }
  }
  void to(ResidualSums& sums) const {
    int k = 0;
    for (int row = 0; row < 6; ++row) {
      sums.b[row] = b[row];
      for (int column = row; column < 6; ++column, ++k)
        sums.h(row, column) = sums.h(column, row) = h[k];
    }
  }
};

float t_weight(float normalised) {
  return (kFreedom + 1) / (kFreedom + normalised * normalised);
}

float t_cost(float normalised) {
  return (kFreedom + 1) / 2 * std::log1p(normalised * normalised / kFreedom);
}

/// The frame's point off the reference's plane: n . (motion * hit - point).
void add_geometric(const ReferencePoint& point, const PointResidual& at, const ResidualScale& scale,
                   bool derivatives, TaskSums& task, ResidualSums& sums) {
  const float residual = at.distance_m / at.sigma_m;
  const float normalised = residual / scale.geometric;
  const float weight = t_weight(normalised);
  sums.geometric_squares += weight * residual * residual;
  sums.geometric_weights += 1;
  if (!derivatives) {
    sums.cost += t_cost(normalised);
    return;
  }
  Vector6f j;
  j << point.normal, at.hit.cross(point.normal);
  j /= at.sigma_m * scale.geometric;
  task.add(j, weight, normalised);
}

/// The frame's intensity where the point projects: the frame moves one way, the point, seen from
/// it, the other.
void add_photometric(const ReferencePoint& point, const PinholeCamera& camera,
                     const PointResidual& at, const ResidualScale& scale, float emphasis,
                     bool derivatives, TaskSums& task, ResidualSums& sums) {
  const float residual = scale.gain * at.intensity + scale.bias - point.intensity;
  const float normalised = residual / scale.photometric;
  const float weight = t_weight(normalised) * emphasis;
  sums.photometric_squares += t_weight(normalised) * residual * residual;
  sums.photometric_count += 1;
  if (!derivatives) {
    sums.cost += emphasis * t_cost(normalised);
    return;
  }
  const float inverse = 1 / point.point.z();
  const float du = point.gradient.x() * camera.fx * inverse,
              dv = point.gradient.y() * camera.fy * inverse;
  const Eigen::Vector3f by_point(du, dv, -(du * point.point.x() + dv * point.point.y()) * inverse);
  Vector6f j;
  j << -by_point, -point.point.cross(by_point);
  j /= scale.photometric;
  task.add(j, weight, normalised);
}

void add_statistics(const ReferencePoint& point, const PointResidual& at, ResidualSums& sums) {
  sums.frame_sum += at.intensity, sums.frame_squares += at.intensity * at.intensity;
  sums.reference_sum += point.intensity,
      sums.reference_squares += point.intensity * point.intensity;
  sums.products += at.intensity * point.intensity;
}

OVIMAP_VECTORIZE ResidualSums sum_range(std::span<const ReferencePoint> points,
                                        const PinholeCamera& camera, const TrackLevel& frame,
                                        const Eigen::Isometry3f& reference_from_frame,
                                        const Eigen::Isometry3f& frame_from_reference,
                                        const ResidualScale& scale,
                                        const FrameAlignmentConfig& config, bool derivatives) {
  ResidualSums sums;
  TaskSums task;
  for (const ReferencePoint& point : points) {
    const PointResidual at =
        residual_of(point, frame, reference_from_frame, frame_from_reference, config, scale.reach);
    sums.points += 1, sums.seen += at.seen, sums.measured += at.measured;
    if (at.near) {
      sums.agreeing += std::fabs(at.distance_m) < kAgree_sigmas * at.sigma_m;
      add_geometric(point, at, scale, derivatives, task, sums);
    } else if (at.measured && !derivatives) {
      sums.cost += t_cost(2 * kAgree_sigmas);  // another surface: as bad as can be, but bounded
    }
    if (!at.textured || (at.measured && !at.near)) continue;
    add_statistics(point, at, sums);
    if (config.photometric_weight > 0)
      add_photometric(point, camera, at, scale, config.photometric_weight, derivatives, task, sums);
  }
  task.to(sums);
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
  const Eigen::Isometry3f forth = reference_from_frame.cast<float>();
  const Eigen::Isometry3f back = reference_from_frame.inverse().cast<float>();
  const std::span<const ReferencePoint> points(reference.points);
  std::vector<ResidualSums> parts((points.size() + kPointsPerTask - 1) / kPointsPerTask);
  parallel_for_ranges(points.size(), kPointsPerTask, [&](std::size_t begin, std::size_t end) {
    parts[begin / kPointsPerTask] = sum_range(points.subspan(begin, end - begin), reference.camera,
                                              frame, forth, back, scale, config, derivatives);
  });
  ResidualSums sums;
  for (const ResidualSums& part : parts) sums += part;
  return sums;
}

}  // namespace ovimap
