// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/concave_edges.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/image/set_bytes.h"
#include "ovimap/segment/task_rows.h"

namespace ovimap {

namespace {

/// Least 1 - cos(angle) that counts as a fold, by depth: a table, as it is asked for every pixel.
class FoldThreshold {
 public:
  FoldThreshold(const DepthSurface& surface, const PinholeCamera& camera,
                const SegmentDepthConfig& config) {
    for (int i = 0; i < kSteps; ++i) {
      const float depth = (static_cast<float>(i) + 0.5f) * kStep_m;
      const float sigma = surface.noise.normal.at(depth) *
                          normal_sigma_rad(depth, surface.radius_px, camera, config.surface.noise);
      // The angle between two independent normals has sqrt(2) times the deviation of one.
      const float angle =
          std::max(config.concave_angle_rad, config.concave_sigmas * std::sqrt(2.f) * sigma);
      least_[i] = 1.f - std::cos(std::min(angle, 3.f));
    }
  }
  float operator()(float depth_m) const {
    return least_[std::min(static_cast<int>(depth_m / kStep_m), kSteps - 1)];
  }
  float least() const { return *std::min_element(std::begin(least_), std::end(least_)); }

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

  /// No fold is weaker than this, wherever it is; a little less, for rounding.
  float least() const { return 0.999f * threshold_.least(); }

  float operator()(int x1, int y1, int x2, int y2) const {
    const Eigen::Vector3f n1 = surface_.normals.at(x1, y1), n2 = surface_.normals.at(x2, y2);
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

/// A row of normals, axis by axis.
struct NormalRow {
  NormalRow(const NormalImage& normals, int row, int first = 0)
      : x(normals.row(0, row) + first),
        y(normals.row(1, row) + first),
        z(normals.row(2, row) + first) {}
  const float *x, *y, *z;
};

/// Marks the pixels of a row whose window is cut, or whose normals at the ends of a whole window
/// differ enough for a fold: the few that are worth a closer look. `before` and `after` are the
/// normals at the ends of the window of pixel 0, `arm1` and `arm2` its arms.
OVIMAP_VECTORIZE void mark_fold_candidates(const NormalRow& before, const NormalRow& after,
                                           const std::uint8_t* arm1, const std::uint8_t* arm2,
                                           int radius, float least, int begin, int end,
                                           std::uint8_t* candidates) {
  const float *x1 = before.x, *y1 = before.y, *z1 = before.z;
  const float *x2 = after.x, *y2 = after.y, *z2 = after.z;
  OVIMAP_NO_OVERLAP
  for (int x = begin; x < end; ++x) {
    const float dot = x1[x] * x2[x] + y1[x] * y2[x] + z1[x] * z2[x];
    const bool cut = (arm1[x] != radius) | (arm2[x] != radius);
    candidates[x] = cut | (1.f - dot >= least);
  }
}

OVIMAP_VECTORIZE void mark_folds(const float* across, const float* down, int width,
                                 std::uint8_t* folds) {
  for (int x = 0; x < width; ++x) folds[x] = (across[x] > 0.f) | (down[x] > 0.f);
}

struct FoldImages {
  Image<float> across;  ///< between left and right
  Image<float> down;    ///< between above and below
};

/// Folds of one row of the images.
class RowFolds {
 public:
  RowFolds(const DepthSurface& surface, const FoldMeasure& fold)
      : surface_(surface),
        fold_(fold),
        width_(surface.breaks.width()),
        radius_(surface.radius_px),
        candidates_(static_cast<std::size_t>(width_)) {}

  void across(int y, float* strength) {
    const std::uint8_t *left = surface_.left_px.row(y), *right = surface_.right_px.row(y);
    std::fill(candidates_.begin(), candidates_.end(), std::uint8_t{1});
    mark_fold_candidates(NormalRow(surface_.normals, y, -radius_),
                         NormalRow(surface_.normals, y, radius_), left, right, radius_,
                         fold_.least(), radius_, width_ - radius_, candidates_.data());
    std::fill_n(strength, width_, 0.f);
    for_each_set(candidates_.data(), width_, [&](int x) {
      if (left[x] + right[x] >= radius_) strength[x] = fold_(x - left[x], y, x + right[x], y);
    });
  }

  void down(int y, float* strength) {
    const std::uint8_t *up = surface_.up_px.row(y), *down = surface_.down_px.row(y);
    std::fill(candidates_.begin(), candidates_.end(), std::uint8_t{1});
    if (y >= radius_ && y + radius_ < surface_.breaks.height())
      mark_fold_candidates(NormalRow(surface_.normals, y - radius_),
                           NormalRow(surface_.normals, y + radius_), up, down, radius_,
                           fold_.least(), 0, width_, candidates_.data());
    std::fill_n(strength, width_, 0.f);
    for_each_set(candidates_.data(), width_, [&](int x) {
      if (up[x] + down[x] >= radius_) strength[x] = fold_(x, y - up[x], x, y + down[x]);
    });
  }

 private:
  const DepthSurface& surface_;
  const FoldMeasure& fold_;
  int width_, radius_;
  std::vector<std::uint8_t> candidates_;
};

FoldImages measure_folds(const DepthSurface& surface, const FoldMeasure& fold) {
  const int width = surface.breaks.width(), height = surface.breaks.height();
  FoldImages folds{Image<float>::unset(width, height), Image<float>::unset(width, height)};
  parallel_for_ranges(static_cast<std::size_t>(height), kPixelRowsPerTask,
                      [&](std::size_t begin, std::size_t end) {
                        RowFolds row(surface, fold);
                        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                          row.across(y, folds.across.row(y));
                          row.down(y, folds.down.row(y));
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
  auto edges = Image<std::uint8_t>::unset(width, height);
  const auto is_ridge = [&](const Image<float>& fold, int x, int y, int dx, int dy) {
    const float strength = fold.at(x, y);
    if (strength <= 0.f) return false;
    for (int k = -reach; k <= reach; ++k)
      if (fold.contains(x + k * dx, y + k * dy) && fold.at(x + k * dx, y + k * dy) > strength)
        return false;
    return true;
  };
  parallel_for(static_cast<std::size_t>(height), kPixelRowsPerTask, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    std::uint8_t* edge = edges.row(y);
    mark_folds(folds.across.row(y), folds.down.row(y), width, edge);
    for_each_set(edge, width, [&](int x) {
      edge[x] = is_ridge(folds.across, x, y, 1, 0) || is_ridge(folds.down, x, y, 0, 1);
    });
  });
  return edges;
}

}  // namespace ovimap
