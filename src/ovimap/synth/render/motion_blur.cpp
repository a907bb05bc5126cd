// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/render/motion_blur.h"

#include <algorithm>
#include <vector>

#include "ovimap/base/parallel.h"

namespace ovimap {
namespace {

constexpr std::size_t kBlurredRowsPerTask = 8;
constexpr float kFarAway_m = 1e3f;

/// Between the four pixels around (u, v); outside, the nearest of the border.
Eigen::Vector3f sampled(const Image<Eigen::Vector3f>& picture, float u, float v) {
  u = std::clamp(u, 0.f, static_cast<float>(picture.width() - 1));
  v = std::clamp(v, 0.f, static_cast<float>(picture.height() - 1));
  const int x = static_cast<int>(u), y = static_cast<int>(v);
  const int right = std::min(x + 1, picture.width() - 1),
            below = std::min(y + 1, picture.height() - 1);
  const float s = u - static_cast<float>(x), t = v - static_cast<float>(y);
  return (1 - t) * ((1 - s) * picture.at(x, y) + s * picture.at(right, y)) +
         t * ((1 - s) * picture.at(x, below) + s * picture.at(right, below));
}

}  // namespace

Image<Eigen::Vector3f> blurred(const Image<Eigen::Vector3f>& picture, const DepthImage& depth,
                               const PinholeCamera& camera, const Pose& world_from_camera,
                               std::span<const Pose> world_from_poses) {
  if (world_from_poses.empty()) return picture;
  std::vector<Eigen::Isometry3f> camera_from_poses;
  for (const Pose& pose : world_from_poses)
    camera_from_poses.emplace_back((world_from_camera.inverse() * pose).cast<float>());
  Image<Eigen::Vector3f> average(picture.width(), picture.height(), Eigen::Vector3f::Zero());
  parallel_for(static_cast<std::size_t>(picture.height()), kBlurredRowsPerTask,
               [&](std::size_t row) {
                 const int y = static_cast<int>(row);
                 for (int x = 0; x < picture.width(); ++x) {
                   const float z = depth.at(x, y) > 0 ? depth.at(x, y) : kFarAway_m;
                   const Eigen::Vector3f point =
                       camera.unproject(static_cast<float>(x), static_cast<float>(y), z);
                   Eigen::Vector3f sum = Eigen::Vector3f::Zero();
                   for (const Eigen::Isometry3f& camera_from_pose : camera_from_poses) {
                     const Eigen::Vector3f p = camera_from_pose * point;
                     const float near = std::max(p.z(), 1e-3f);
                     sum += sampled(picture, camera.fx * p.x() / near + camera.cx,
                                    camera.fy * p.y() / near + camera.cy);
                   }
                   average.at(x, y) = sum / static_cast<float>(camera_from_poses.size());
                 }
               });
  return average;
}

}  // namespace ovimap
