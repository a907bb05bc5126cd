// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace ovimap {

/// A uniform cubic B-spline: continuous up to its second derivative, and nowhere faster than its
/// quickest step from one control point to the next. It stays among four neighbouring points and
/// need not meet any of them.
class PlaneSpline {
 public:
  PlaneSpline() = default;
  /// One control point every `spacing_s`; `closed`: after the last comes the first again, otherwise
  /// it rests at both ends. There must be a point.
  PlaneSpline(std::vector<Eigen::Vector2d> points, double spacing_s, bool closed)
      : points_(std::move(points)), spacing_s_(spacing_s), closed_(closed) {}

  Eigen::Vector2d at(double time_s) const {
    const double place = time_s / spacing_s_, first = std::floor(place), t = place - first;
    const auto i = static_cast<long>(first);
    const double s = 1 - t;
    return (s * s * s * point(i - 1) + (4 + 3 * t * t * (t - 2)) * point(i) +
            (4 + 3 * s * s * (s - 2)) * point(i + 1) + t * t * t * point(i + 2)) /
           6;
  }

  /// Of one round where it is closed.
  double seconds() const { return spacing_s_ * static_cast<double>(points_.size()); }

 private:
  const Eigen::Vector2d& point(long i) const {
    const auto count = static_cast<long>(points_.size());
    const long index = closed_ ? (i % count + count) % count : std::clamp(i, 0L, count - 1);
    return points_[static_cast<std::size_t>(index)];
  }

  std::vector<Eigen::Vector2d> points_;
  double spacing_s_ = 1;
  bool closed_ = false;
};

}  // namespace ovimap
