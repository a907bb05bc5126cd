// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/motion/contradicting_pixels.h"

#include <algorithm>

#include "ovimap/base/lanes.h"
#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/pipeline/motion/frame_points.h"

namespace ovimap {

namespace {

constexpr std::size_t kRowsPerTask = 16;
constexpr float kUnknownSlope = 0.5f;  // of a plane that does not fit, as FreeSpaceConfig takes it
constexpr float kLeastSlope = 0.1f;

/// The cells of eight pixels along a row, by coordinate.
struct CellsOfPixels {
  std::int32_t x[kLanes], y[kLanes], z[kLanes];
  bool same;  ///< all of them in one

  BlockIndex at(int lane) const { return {x[lane], y[lane], z[lane]}; }
};

OVIMAP_VECTORIZE void find_cells(const PixelRays::Row& ray, const Eigen::Vector3f& origin,
                                 float inverse_cell, const float* depth_m, int x,
                                 CellsOfPixels& cells) {
  const Floats depth = load(depth_m + x);
  const auto along = [&](const float* columns, int axis) __attribute__((always_inline)) {
    return floor_of((origin[axis] + (load(columns + x) + ray.part[axis]) * depth) * inverse_cell);
  };
  const Ints cx = along(ray.column_x, 0), cy = along(ray.column_y, 1), cz = along(ray.column_z, 2);
  cells.same = !any((cx != cx[0]) | (cy != cy[0]) | (cz != cz[0]));
  std::memcpy(cells.x, &cx, sizeof(cx));
  std::memcpy(cells.y, &cy, sizeof(cy));
  std::memcpy(cells.z, &cz, sizeof(cz));
}

/// One per thread.
class RowReader {
 public:
  RowReader(const VoxelMapConfig& map, const SeenFree& space, const Observation& seen,
            const FramePoints& points, const MotionConfig& config)
      : seen_(seen),
        points_(points),
        config_(config),
        inverse_cell_(1.f / map.block_size_m()),
        margin_m_(config.margin_voxels * map.voxel_size_m),
        surface_(space),
        behind_(space) {}

  void read(int y, std::uint8_t* result) {
    const float* const depth_m = seen_.depth.row(y);
    const PixelRays::Row ray = points_.row(y);
    const int width = seen_.depth.width();
    int x = 0;
    for (CellsOfPixels cells; x + kLanes <= width; x += kLanes) {
      find_cells(ray, points_.origin(), inverse_cell_, depth_m, x, cells);
      if (cells.same && !is_empty(surface_, cells.at(0))) continue;
      for (int lane = 0; lane < kLanes; ++lane)
        result[x + lane] =
            depth_m[x + lane] > 0.f && is_empty(surface_, cells.at(lane)) && goes_on(x + lane, y);
    }
    for (; x < width; ++x)
      result[x] = depth_m[x] > 0.f &&
                  is_empty(surface_, block_at(points_.at(x, y, depth_m[x]), inverse_cell_)) &&
                  goes_on(x, y);
  }

 private:
  bool is_empty(SpaceFinder& space, const BlockIndex& cell) const {
    return space.at(cell).looks >= config_.looks;
  }
  /// Whether what lies behind the surface was seen empty as well.
  bool goes_on(int x, int y) {
    const float fitted = seen_.plane_slope->at(x, y);
    const float slope = fitted > 0.f ? std::max(fitted, kLeastSlope) : kUnknownSlope;
    const float margin = std::max(margin_m_ / slope, config_.sigmas * seen_.sigma_m->at(x, y));
    const Eigen::Vector3f point = points_.at(x, y, seen_.depth.at(x, y) + margin);
    return is_empty(behind_, block_at(point, inverse_cell_));
  }

  const Observation& seen_;
  const FramePoints& points_;
  const MotionConfig& config_;
  float inverse_cell_, margin_m_;
  SpaceFinder surface_, behind_;
};

}  // namespace

Image<std::uint8_t> contradicting_pixels(const VoxelMapConfig& map, const SeenFree& space,
                                         const Observation& seen, const MotionConfig& config) {
  const FramePoints points(seen);
  Image<std::uint8_t> result(seen.depth.width(), seen.depth.height());
  parallel_for_ranges(static_cast<std::size_t>(seen.depth.height()), kRowsPerTask,
                      [&](std::size_t begin, std::size_t end) {
                        RowReader reader(map, space, seen, points, config);
                        for (std::size_t y = begin; y < end; ++y)
                          reader.read(static_cast<int>(y), result.row(static_cast<int>(y)));
                      });
  return result;
}

}  // namespace ovimap
