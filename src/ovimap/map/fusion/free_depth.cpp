// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <vector>

#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/map/fusion/free_space.h"

namespace ovimap {

namespace {

constexpr std::size_t kCellRowsPerTask = 8;
constexpr float kNoAnswer = std::numeric_limits<float>::max();

/// What each pixel's own ray says is cut off before the plane that it sees.
struct FreeLimits {
  float margin_m, sigmas, least_slope, unknown_slope;
};

/// Adds a row of pixels to the least free depth of each column, and to its count of pixels that
/// have no answer.
OVIMAP_VECTORIZE void add_row(const FreeLimits& limits, const float* depth_m, const float* fitted,
                              const float* sigma_m, int width, float* least_m, int* holes) {
  OVIMAP_NO_OVERLAP
  for (int x = 0; x < width; ++x) {
    const float slope = fitted[x] > 0.f ? fitted[x] : limits.unknown_slope;
    const float off_plane_m = limits.margin_m / slope, off_ray_m = limits.sigmas * sigma_m[x];
    const float free_m = depth_m[x] - (off_plane_m < off_ray_m ? off_ray_m : off_plane_m);
    const bool hole = (depth_m[x] <= 0.f) | (slope < limits.least_slope);
    const float answer = hole ? kNoAnswer : free_m;
    least_m[x] = answer < least_m[x] ? answer : least_m[x];
    holes[x] += hole ? 1 : 0;
  }
}

/// The least of three rows and the sum of three.
OVIMAP_VECTORIZE void join_rows(const float* const least_m[3], const int* const holes[3], int width,
                                float* least, int* sum) {
  OVIMAP_NO_OVERLAP
  for (int x = 0; x < width; ++x) {
    const float two = least_m[0][x] < least_m[1][x] ? least_m[0][x] : least_m[1][x];
    least[x] = two < least_m[2][x] ? two : least_m[2][x];
    sum[x] = holes[0][x] + holes[1][x] + holes[2][x];
  }
}

/// Squares of pixels and what they say together.
class Cells {
 public:
  Cells(const Observation& seen, const FreeLimits& limits, int side)
      : width_(seen.depth.width()),
        height_(seen.depth.height()),
        side_(side),
        least_m_((width_ + side - 1) / side, (height_ + side - 1) / side, kNoAnswer),
        holes_(least_m_.width(), least_m_.height()),
        outside_m_(static_cast<std::size_t>(least_m_.width()), kNoAnswer),
        no_holes_(outside_m_.size(), 0) {
    const std::vector<float> not_known(static_cast<std::size_t>(width_), 0.f);
    parallel_for(static_cast<std::size_t>(rows()), kCellRowsPerTask, [&](std::size_t row) {
      read(seen, limits, not_known.data(), static_cast<int>(row));
    });
  }
  int rows() const { return least_m_.height(); }

  /// The free depth of all pixels in a row of cells: of each with the cells around it.
  void write(int row, float most_holes, Image<float>& free_m) const {
    std::vector<float> least(outside_m_.size());
    std::vector<int> holes(least.size());
    const float* const least_m[3] = {least_of(row - 1), least_of(row), least_of(row + 1)};
    const int* const counts[3] = {holes_of(row - 1), holes_of(row), holes_of(row + 1)};
    const int columns = least_m_.width();
    join_rows(least_m, counts, columns, least.data(), holes.data());
    const int pixels_down = extent(row, height_);
    float* into = free_m.row(row * side_);
    for (int column = 0; column < columns; ++column) {
      float around_m = kNoAnswer;
      int missing = 0;
      for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns - 1); ++x) {
        around_m = std::min(around_m, least[static_cast<std::size_t>(x)]);
        missing += holes[static_cast<std::size_t>(x)];
      }
      const float allowed = most_holes * static_cast<float>(pixels_down * extent(column, width_));
      const float answer = static_cast<float>(missing) > allowed ? 0.f : std::max(around_m, 0.f);
      std::fill_n(into + column * side_, std::min(side_, width_ - column * side_), answer);
    }
    for (int y = row * side_ + 1; y < std::min((row + 1) * side_, height_); ++y)
      std::copy_n(into, width_, free_m.row(y));
  }

 private:
  void read(const Observation& seen, const FreeLimits& limits, const float* not_known, int row) {
    std::vector<float> least(static_cast<std::size_t>(width_), kNoAnswer);
    std::vector<int> holes(least.size(), 0);
    for (int y = row * side_; y < std::min((row + 1) * side_, height_); ++y)
      add_row(limits, seen.depth.row(y), seen.plane_slope ? seen.plane_slope->row(y) : not_known,
              seen.sigma_m->row(y), width_, least.data(), holes.data());
    float* const into_m = least_m_.row(row);
    int* const into = holes_.row(row);
    for (int x = 0, column = 0, in_cell = 0; x < width_; ++x) {
      into_m[column] = std::min(into_m[column], least[static_cast<std::size_t>(x)]);
      into[column] += holes[static_cast<std::size_t>(x)];
      if (++in_cell == side_) ++column, in_cell = 0;
    }
  }

  bool has(int row) const { return row >= 0 && row < rows(); }
  const float* least_of(int row) const { return has(row) ? least_m_.row(row) : outside_m_.data(); }
  const int* holes_of(int row) const { return has(row) ? holes_.row(row) : no_holes_.data(); }
  /// Pixels along an edge of the image that a cell covers with those beside it.
  int extent(int cell, int edge_px) const {
    return std::min((cell + 2) * side_, edge_px) - std::max((cell - 1) * side_, 0);
  }

  int width_, height_, side_;
  Image<float> least_m_;
  Image<int> holes_;
  std::vector<float> outside_m_;  ///< a row beyond the image
  std::vector<int> no_holes_;
};

}  // namespace

Image<float> free_depth(const VoxelMapConfig& map, const Observation& observation,
                        const FreeSpaceConfig& config) {
  OVIMAP_ASSERT(observation.sigma_m != nullptr);
  const FreeLimits limits{config.margin_voxels * map.voxel_size_m, config.sigmas,
                          config.least_slope, config.unknown_slope};
  const Cells cells(observation, limits, config.guard_px);
  auto free_m = Image<float>::unset(observation.depth.width(), observation.depth.height());
  parallel_for(static_cast<std::size_t>(cells.rows()), kCellRowsPerTask,
               [&](std::size_t row) { cells.write(static_cast<int>(row), config.holes, free_m); });
  return free_m;
}

const Image<float>& free_depth(const VoxelMapConfig& map, const Observation& observation,
                               const FreeSpaceConfig& config, Image<float>& made) {
  if (observation.free_m) return *observation.free_m;
  return made = free_depth(map, observation, config);
}

}  // namespace ovimap
