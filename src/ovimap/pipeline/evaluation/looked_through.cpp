// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/evaluation/looked_through.h"

#include <algorithm>
#include <cmath>

namespace ovimap {

void LookedThrough::add(const FrameSource& source) {
  for (std::int64_t i = 0; i < source.size(); ++i)
    if (const FrameRead read = source.read(i); read.frame) add(*read.frame);
}

std::size_t LookedThrough::count(int frames, std::size_t first, std::size_t points) const {
  const auto begin = counts_.begin() + static_cast<std::ptrdiff_t>(first);
  return static_cast<std::size_t>(std::count_if(begin, begin + static_cast<std::ptrdiff_t>(points),
                                                [&](int count) { return count >= frames; }));
}

Points LookedThrough::at_least(int frames) const {
  Points points;
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (counts_[i] >= frames) points.push_back(points_[i]);
  return points;
}

void LookedThrough::add(const Frame& frame) {
  const Eigen::Isometry3f camera_from_world = frame.world_from_camera.inverse().cast<float>();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector3f point = camera_from_world * points_[i];
    if (point.z() <= 0.f) continue;
    const Eigen::Vector2f pixel = frame.depth_camera.project(point);
    const int x = static_cast<int>(std::lround(pixel.x())),
              y = static_cast<int>(std::lround(pixel.y()));
    if (frame.depth.contains(x, y) && frame.depth.at(x, y) > 0.f &&
        frame.depth.at(x, y) > point.z() + behind_m_)
      ++counts_[i];
  }
}

}  // namespace ovimap
