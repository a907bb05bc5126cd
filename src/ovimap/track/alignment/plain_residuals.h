// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/track/alignment/point_residuals.h"
#include "ovimap/track/alignment/residuals.h"

namespace ovimap {

/// Intensity between pixels, bilinear; -1 where a neighbour is unknown or outside.
inline float plain_intensity_at(const Image<float>& image, float u, float v) {
  const int x = static_cast<int>(u), y = static_cast<int>(v);
  if (!(u >= 0 && v >= 0) || x + 1 >= image.width() || y + 1 >= image.height()) return -1;
  const float* upper = image.row(y) + x;
  const float* lower = image.row(y + 1) + x;
  if (upper[0] < 0 || upper[1] < 0 || lower[0] < 0 || lower[1] < 0) return -1;
  const float right = u - static_cast<float>(x), down = v - static_cast<float>(y);
  const float top = upper[0] + right * (upper[1] - upper[0]);
  const float bottom = lower[0] + right * (lower[1] - lower[0]);
  return top + down * (bottom - top);
}

/// What a frame says of one point.
inline PointResidual plain_residual(const ReferencePoint& point, const TrackLevel& frame,
                                    const Eigen::Isometry3f& reference_from_frame,
                                    const Eigen::Isometry3f& frame_from_reference,
                                    const FrameAlignmentConfig& config, float reach) {
  PointResidual at;
  const Eigen::Vector3f in_frame = frame_from_reference * point.point;
  if (in_frame.z() <= kNearest_m) return at;
  const Eigen::Vector2f pixel = frame.camera.project(in_frame);
  const auto width = static_cast<float>(frame.camera.width),
             height = static_cast<float>(frame.camera.height);
  if (!(pixel.x() > -0.5f && pixel.y() > -0.5f && pixel.x() < width - 0.5f &&
        pixel.y() < height - 0.5f))
    return at;
  const int x = static_cast<int>(pixel.x() + 0.5f), y = static_cast<int>(pixel.y() + 0.5f);
  at.seen = true;
  if (point.intensity >= 0) {
    at.intensity = plain_intensity_at(frame.intensity, pixel.x(), pixel.y());
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

/// sum_residuals as the method says it, sums and cost together: one point after another in double
/// precision, derivatives by trying out small motions of the frame. For tests.
inline ResidualSums plain_sum_residuals(const ReferenceLevel& reference, const TrackLevel& frame,
                                        const Pose& reference_from_frame,
                                        const ResidualScale& scale,
                                        const FrameAlignmentConfig& config) {
  constexpr double kTry = 1e-3, kFreedom = 5;
  const Eigen::Isometry3f forth = reference_from_frame.cast<float>();
  const Eigen::Isometry3f back = reference_from_frame.inverse().cast<float>();
  const auto weight = [](double r) { return (kFreedom + 1) / (kFreedom + r * r); };
  const auto cost = [](double r) { return (kFreedom + 1) / 2 * std::log1p(r * r / kFreedom); };
  const auto tried = [](int axis, double by) {
    Vector6d motion = Vector6d::Zero();
    motion[axis] = by;
    return small_motion(motion);
  };
  ResidualSums sums;
  for (std::size_t i = 0; i < reference.points.size(); ++i) {
    const ReferencePoint point = reference.points[i];
    const PointResidual at = plain_residual(point, frame, forth, back, config, scale.reach);
    sums.points += 1, sums.seen += at.seen, sums.measured += at.measured;
    const Eigen::Vector3d normal = point.normal.cast<double>(), place = point.point.cast<double>();
    if (at.near) {
      const double unit = at.sigma_m * scale.geometric, r = at.distance_m / unit;
      Vector6d j;
      for (int axis = 0; axis < 6; ++axis) {
        const auto off = [&](double by) {
          return normal.dot(tried(axis, by) * at.hit.cast<double>() - place) / unit;
        };
        j[axis] = (off(kTry) - off(-kTry)) / (2 * kTry);
      }
      sums.h += weight(r) * j * j.transpose();
      sums.b -= weight(r) * r * j;
      sums.cost += cost(r);
      sums.agreeing += std::fabs(at.distance_m) < 3 * at.sigma_m;
    } else if (at.measured) {
      sums.cost += cost(6);  // another surface: as bad as can be, but bounded
    }
    if (!at.textured || (at.measured && !at.near)) continue;
    // Where the point appears in the reference when the frame moves: its intensity changes by the
    // gradient there.
    const double r = (scale.gain * at.intensity + scale.bias - point.intensity) / scale.photometric;
    const PinholeCamera& camera = reference.camera;
    const auto pixel = [&](int axis, double by) {
      const Eigen::Vector3d moved = tried(axis, by).inverse() * place;
      return Eigen::Vector2d(camera.fx * moved.x() / moved.z(), camera.fy * moved.y() / moved.z());
    };
    Vector6d j;
    for (int axis = 0; axis < 6; ++axis)
      j[axis] = point.gradient.cast<double>().dot(pixel(axis, kTry) - pixel(axis, -kTry)) /
                (2 * kTry) / scale.photometric;
    sums.h += config.photometric_weight * weight(r) * j * j.transpose();
    sums.b -= config.photometric_weight * weight(r) * r * j;
    sums.cost += config.photometric_weight * cost(r);
    sums.photometric_count += 1;
    sums.products += at.intensity * point.intensity;
  }
  return sums;
}

}  // namespace ovimap
