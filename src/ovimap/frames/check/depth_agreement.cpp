// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/check/depth_agreement.h"

#include <algorithm>
#include <cmath>

namespace ovimap {

namespace {

/// Stored units that get mixed up: millimetres and metres, TUM's 5000 and Replica's 6553.5 a metre.
constexpr double kFocalStep = 1.07;  // finer, and neighbours cannot be told apart
constexpr int kFocalSteps = 11;      // to half and to twice the focal length
constexpr double kDepthFactors[] = {1, 10, 0.1, 5, 0.2, 6.5535, 1 / 6.5535, 1000, 0.001};

/// Takes a pixel and its depth as read in one frame to pixel and depth in another:
/// (x, y, z) = depth * (column * u + row * v + corner) + offset, in units of the other's pixels.
struct PixelTransfer {
  Eigen::Vector3f column, row, corner, offset;

  PixelTransfer(const ThinFrame& from, const ThinFrame& to, const Reinterpretation& reading) {
    const Pose to_from_from =
        reading.pose(to.world_from_camera).inverse() * reading.pose(from.world_from_camera);
    const Eigen::Matrix3d into = intrinsics(to.camera, reading.focal_factor);
    const Eigen::Matrix3d rays = into * to_from_from.linear() *
                                 intrinsics(from.camera, reading.focal_factor).inverse() *
                                 reading.depth_factor;
    column = rays.col(0).cast<float>();
    row = rays.col(1).cast<float>();
    corner = rays.col(2).cast<float>();
    offset = (into * to_from_from.translation()).cast<float>();
  }

  static Eigen::Matrix3d intrinsics(const PinholeCamera& camera, double focal_factor) {
    Eigen::Matrix3d matrix;
    matrix << camera.fx * focal_factor, 0, camera.cx, 0, camera.fy * focal_factor, camera.cy, 0, 0,
        1;
    return matrix;
  }
};

/// Plain numbers per pixel: this runs for every reading of every pair.
void add_row(const float* depth_m, int width, const PixelTransfer& transfer,
             const Eigen::Vector3f& row_start, const DepthImage& to, float factor, float tolerance,
             Agreement& sum) {
  const float cx = transfer.column.x(), cy = transfer.column.y(), cz = transfer.column.z();
  const float rx = row_start.x(), ry = row_start.y(), rz = row_start.z();
  const float tx = transfer.offset.x(), ty = transfer.offset.y(), tz = transfer.offset.z();
  const auto to_width = static_cast<float>(to.width()), to_height = static_cast<float>(to.height());
  for (int column = 0; column < width; ++column) {
    const float d = depth_m[column], u = static_cast<float>(column);
    if (!(d > 0)) continue;
    ++sum.points;
    const float z = d * (cz * u + rz) + tz;
    if (!(z > 0)) continue;
    const float x = (d * (cx * u + rx) + tx) / z + 0.5f, y = (d * (cy * u + ry) + ty) / z + 0.5f;
    if (!(x >= 0 && y >= 0 && x < to_width && y < to_height)) continue;
    const float seen_m = to.row(static_cast<int>(y))[static_cast<int>(x)] * factor;
    if (!(seen_m > 0)) continue;
    ++sum.compared;
    sum.agreeing += std::abs(z - seen_m) <= tolerance * seen_m ? 1 : 0;
  }
}

void add_projection(const ThinFrame& from, const ThinFrame& to, const Reinterpretation& reading,
                    double tolerance, Agreement& sum) {
  const PixelTransfer transfer(from, to, reading);
  for (int v = 0; v < from.depth.height(); ++v) {
    const Eigen::Vector3f row_start = transfer.row * static_cast<float>(v) + transfer.corner;
    add_row(from.depth.row(v), from.depth.width(), transfer, row_start, to.depth,
            static_cast<float>(reading.depth_factor), static_cast<float>(tolerance), sum);
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
  thin.position = frame.index;
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
        readings.push_back({direction, axes, factor, 1});
  for (int step = -kFocalSteps; step <= kFocalSteps; ++step)
    if (step != 0) readings.push_back({.focal_factor = std::pow(kFocalStep, step)});
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
