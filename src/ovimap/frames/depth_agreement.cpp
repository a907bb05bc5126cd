// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/depth_agreement.h"

#include <algorithm>
#include <cmath>

namespace ovimap {

namespace {

/// Stored units that get mixed up: millimetres and metres, TUM's 5000 and Replica's 6553.5 a metre.
constexpr double kDepthFactors[] = {1, 10, 0.1, 5, 0.2, 6.5535, 1 / 6.5535, 1000, 0.001};

void add_projection(const ThinFrame& from, const ThinFrame& to, const Reinterpretation& reading,
                    double tolerance, Agreement& sum) {
  const Eigen::Isometry3f to_from_from =
      (reading.pose(to.world_from_camera).inverse() * reading.pose(from.world_from_camera))
          .cast<float>();
  const auto factor = static_cast<float>(reading.depth_factor);
  for (int v = 0; v < from.depth.height(); ++v)
    for (int u = 0; u < from.depth.width(); ++u) {
      const float depth_m = from.depth.at(u, v);
      if (!(depth_m > 0)) continue;
      ++sum.points;
      const Eigen::Vector3f point =
          to_from_from *
          from.camera.unproject(static_cast<float>(u), static_cast<float>(v), depth_m * factor);
      if (!(point.z() > 0)) continue;
      const Eigen::Vector2f pixel = to.camera.project(point);
      const float x = std::floor(pixel.x() + 0.5f), y = std::floor(pixel.y() + 0.5f);
      const bool inside = x >= 0 && y >= 0 && x < static_cast<float>(to.depth.width()) &&
                          y < static_cast<float>(to.depth.height());
      if (!inside) continue;
      const float seen_m = to.depth.at(static_cast<int>(x), static_cast<int>(y)) * factor;
      if (!(seen_m > 0)) continue;
      ++sum.compared;
      sum.agreeing += std::abs(point.z() - seen_m) <= tolerance * seen_m ? 1 : 0;
    }
}

}  // namespace

ThinFrame thin_frame(const Frame& frame, int max_width_px) {
  const int step = std::max(1, (frame.depth.width() + max_width_px - 1) / max_width_px);
  const auto scale = static_cast<float>(step);
  const PinholeCamera& camera = frame.depth_camera;
  ThinFrame thin;
  thin.depth =
      DepthImage((frame.depth.width() - 1) / step + 1, (frame.depth.height() - 1) / step + 1);
  // Kept pixels sit at multiples of the step, so pixel coordinates are divided by it.
  thin.camera = {thin.depth.width(), thin.depth.height(), camera.fx / scale,
                 camera.fy / scale,  camera.cx / scale,   camera.cy / scale};
  for (int v = 0; v < thin.depth.height(); ++v)
    for (int u = 0; u < thin.depth.width(); ++u)
      thin.depth.at(u, v) = frame.depth.at(u * step, v * step);
  thin.world_from_camera = frame.world_from_camera;
  return thin;
}

Pose Reinterpretation::pose(const Pose& as_read) const {
  PoseConvention convention;
  convention.direction = direction;
  convention.axes = axes;
  return pose_by_convention(convention, as_read);
}

std::vector<Reinterpretation> usual_reinterpretations() {
  using Direction = PoseConvention::Direction;
  using Axes = PoseConvention::Axes;
  std::vector<Reinterpretation> readings;
  for (const double factor : kDepthFactors)
    for (const Axes axes : {Axes::kOpenCv, Axes::kOpenGl, Axes::kRos})
      for (const Direction direction : {Direction::kWorldFromCamera, Direction::kCameraFromWorld})
        readings.push_back({direction, axes, factor});
  return readings;
}

Agreement measure_agreement(const std::vector<std::pair<ThinFrame, ThinFrame>>& pairs,
                            const Reinterpretation& reading, double tolerance) {
  Agreement sum;
  for (const auto& [a, b] : pairs) {
    add_projection(a, b, reading, tolerance, sum);
    add_projection(b, a, reading, tolerance, sum);
  }
  return sum;
}

}  // namespace ovimap
