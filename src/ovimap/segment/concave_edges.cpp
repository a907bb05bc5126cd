// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/concave_edges.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

constexpr std::size_t kRowsPerTask = 16;

/// Least 1 - cos(angle) that counts as a fold, by depth: a table, as it is asked for every pixel.
class FoldThreshold {
 public:
  FoldThreshold(const DepthSurface& surface, const PinholeCamera& camera,
                const SegmentDepthConfig& config) {
    for (int i = 0; i < kSteps; ++i) {
      const float depth = (static_cast<float>(i) + 0.5f) * kStep_m;
      const float sigma = normal_sigma_rad(depth, surface.radius_px, camera, config.surface.noise);
      // The angle between two independent normals has sqrt(2) times the deviation of one.
      const float angle =
          std::max(config.concave_angle_rad, config.concave_sigmas * std::sqrt(2.f) * sigma);
      least_[i] = 1.f - std::cos(std::min(angle, 3.f));
    }
  }
  float operator()(float depth_m) const {
    return least_[std::min(static_cast<int>(depth_m / kStep_m), kSteps - 1)];
  }

 private:
  static constexpr int kSteps = 200;
  static constexpr float kStep_m = 0.05f;
  float least_[kSteps];
};

/// Fold strength 1 - cos(angle) between two pixels when it is concave and strong enough, else 0.
class FoldMeasure {
 public:
  FoldMeasure(const DepthSurface& surface, const PinholeCamera& camera,
              const SegmentDepthConfig& config)
      : surface_(surface), camera_(camera), threshold_(surface, camera, config) {}

  float operator()(int x1, int y1, int x2, int y2) const {
    const Eigen::Vector3f& n1 = surface_.normals.at(x1, y1);
    const Eigen::Vector3f& n2 = surface_.normals.at(x2, y2);
    const float strength = 1.f - n1.dot(n2);
    const float depth = surface_.smooth_depth_m.at(x1, y1);
    // A zero normal (no plane) has a dot product of 0 with everything: not a fold.
    if (strength < threshold_(depth) || n1.isZero() || n2.isZero()) return 0.f;
    const Eigen::Vector3f p1 = point(x1, y1, depth),
                          p2 = point(x2, y2, surface_.smooth_depth_m.at(x2, y2));
    return (p2 - p1).dot(n1 - n2) > 0.f ? strength : 0.f;
  }

 private:
  Eigen::Vector3f point(int x, int y, float depth) const {
    return camera_.unproject(static_cast<float>(x), static_cast<float>(y), depth);
  }

  const DepthSurface& surface_;
  const PinholeCamera& camera_;
  FoldThreshold threshold_;
};

struct FoldImages {
  Image<float> across;  ///< between left and right
  Image<float> down;    ///< between above and below
};

/// Unbroken pixels above / below (x, y), at most `radius`.
int column_arm(const DepthSurface& surface, int x, int y, int direction, int radius) {
  int arm = 0;
  for (int row = y; arm < radius; ++arm, row += direction) {
    const int upper = direction < 0 ? row - 1 : row;
    if (upper < 0 || upper + 1 >= surface.breaks.height()) break;
    if (surface.breaks.at(x, upper) & DepthSurface::kBelow) break;
  }
  return arm;
}

FoldImages measure_folds(const DepthSurface& surface, const FoldMeasure& fold) {
  const int width = surface.breaks.width(), height = surface.breaks.height(),
            radius = surface.radius_px;
  FoldImages folds{Image<float>(width, height), Image<float>(width, height)};
  parallel_for(static_cast<std::size_t>(height), kRowsPerTask, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      if (surface.smooth_depth_m.at(x, y) <= 0.f) continue;
      const int left = surface.left_px.at(x, y), right = surface.right_px.at(x, y);
      if (left + right >= radius) folds.across.at(x, y) = fold(x - left, y, x + right, y);
      const int up = column_arm(surface, x, y, -1, radius),
                down = column_arm(surface, x, y, 1, radius);
      if (up + down >= radius) folds.down.at(x, y) = fold(x, y - up, x, y + down);
    }
  });
  return folds;
}

}  // namespace

Image<std::uint8_t> find_concave_edges(const DepthSurface& surface, const PinholeCamera& camera,
                                       const SegmentDepthConfig& config) {
  const FoldImages folds = measure_folds(surface, FoldMeasure(surface, camera, config));
  const int width = surface.breaks.width(), height = surface.breaks.height();
  const int reach = std::max(1, surface.radius_px / 3);
  Image<std::uint8_t> edges(width, height);
  const auto is_ridge = [&](const Image<float>& fold, int x, int y, int dx, int dy) {
    const float strength = fold.at(x, y);
    if (strength <= 0.f) return false;
    for (int k = -reach; k <= reach; ++k)
      if (fold.contains(x + k * dx, y + k * dy) && fold.at(x + k * dx, y + k * dy) > strength)
        return false;
    return true;
  };
  parallel_for(static_cast<std::size_t>(height), kRowsPerTask, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x)
      edges.at(x, y) = is_ridge(folds.across, x, y, 1, 0) || is_ridge(folds.down, x, y, 0, 1);
  });
  return edges;
}

}  // namespace ovimap
