// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/map/fusion/integrate.h"
#include "ovimap/map/rays/pixel_rays.h"

namespace ovimap {

/// A point that lies no further from the map's surface is of it.
inline constexpr float kOnSurface_voxels = 2.f;

/// A frame's points in the world, metres. The observation must stay.
class FramePoints {
 public:
  explicit FramePoints(const Observation& seen)
      : depth_(seen.depth),
        rays_(seen.camera, seen.world_from_camera.linear().cast<float>()),
        origin_(seen.world_from_camera.translation().cast<float>()) {}

  Eigen::Vector3f at(int x, int y, float depth_m) const {
    return origin_ + rays_.at(x, y) * depth_m;
  }
  /// Of an image row, from `origin`.
  PixelRays::Row row(int y) const { return rays_.row(y); }
  const Eigen::Vector3f& origin() const { return origin_; }
  /// Of a pixel by its place in the image, row by row.
  Eigen::Vector3f at(int pixel) const {
    const int x = pixel % depth_.width(), y = pixel / depth_.width();
    return at(x, y, depth_.at(x, y));
  }

 private:
  const DepthImage& depth_;
  PixelRays rays_;
  Eigen::Vector3f origin_;
};

}  // namespace ovimap
