// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/picture_motion.h"

#include <algorithm>

#include "ovimap/base/median.h"

namespace ovimap {

namespace {

constexpr int kColumns = 40;  // of the grid of pixels that are looked at
constexpr float kPatience =
    1.5f;  // a slow frame is waited for until so many times the least motion
constexpr std::size_t kWalk = 30;  // poses; as many as a camera takes in a second

bool sees(const PinholeCamera& camera, const Eigen::Vector3f& point) {
  if (point.z() <= 0.f) return false;
  const Eigen::Vector2f pixel = camera.project(point);
  return pixel.minCoeff() > -0.5f && pixel.x() < static_cast<float>(camera.width) - 0.5f &&
         pixel.y() < static_cast<float>(camera.height) - 0.5f;
}

}  // namespace

float picture_motion(const Frame& frame, const Pose& earlier_from_now) {
  const PinholeCamera& camera = frame.depth_camera;
  const Eigen::Isometry3f motion = earlier_from_now.cast<float>();
  const auto width = static_cast<float>(camera.width);
  const int step = std::max(1, camera.width / kColumns);
  std::vector<float> moved;
  for (int y = step / 2; y < frame.depth.height(); y += step) {
    for (int x = step / 2; x < frame.depth.width(); x += step) {
      const float z = frame.depth.at(x, y);
      if (z <= 0.f) continue;
      const Eigen::Vector2f now(static_cast<float>(x), static_cast<float>(y));
      const Eigen::Vector3f point = motion * camera.unproject(now.x(), now.y(), z);
      moved.push_back(
          sees(camera, point) ? std::min(1.f, (camera.project(point) - now).norm() / width) : 1.f);
    }
  }
  return moved.empty() ? 0.f : median_of(moved);
}

bool MaskMotion::wants(const Frame& frame) const {
  if (!masked_) return true;
  const float moved =
      picture_motion(frame, walk_.front().world_from_camera.inverse() * frame.world_from_camera);
  return moved >= least_ && (moved >= kPatience * least_ || slow(frame));
}

void MaskMotion::add(const Pose& world_from_camera) {
  if (walk_.size() == kWalk) walk_.erase(walk_.begin() + 1);
  walk_.push_back({frames_++, world_from_camera});
}

void MaskMotion::masked() {
  walk_.erase(walk_.begin(), walk_.end() - 1);
  masked_ = true;
}

void MaskMotion::move(std::span<const Pose> world_from_camera) {
  for (Step& step : walk_)
    if (step.frame < world_from_camera.size())
      step.world_from_camera = world_from_camera[step.frame];
}

/// Whether the picture moves no faster than it usually did since the last masks.
bool MaskMotion::slow(const Frame& frame) const {
  std::vector<float> steps;
  for (std::size_t i = 1; i < walk_.size(); ++i)
    steps.push_back(picture_motion(
        frame, walk_[i - 1].world_from_camera.inverse() * walk_[i].world_from_camera));
  return steps.empty() || picture_motion(frame, walk_.back().world_from_camera.inverse() *
                                                    frame.world_from_camera) <= median_of(steps);
}

}  // namespace ovimap
