// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "ovimap/base/parallel.h"
#include "ovimap/map/fusion/free_space.h"

namespace ovimap {

namespace {

constexpr std::size_t kCellRowsPerTask = 8;  // of cells

/// What the pixels of a cell say together.
struct Cell {
  float free_m = std::numeric_limits<float>::max();
  int pixels = 0, holes = 0;

  void add(const Cell& other) {
    free_m = std::min(free_m, other.free_m);
    pixels += other.pixels;
    holes += other.holes;
  }
};

class CellMaker {
 public:
  CellMaker(const VoxelMapConfig& map, const Observation& observation,
            const FreeSpaceConfig& config)
      : seen_(observation), config_(config), margin_m_(config.margin_voxels * map.voxel_size_m) {}

  Cell cell(int column, int row) const {
    Cell result;
    const int side = config_.guard_px;
    for (int y = row * side; y < std::min((row + 1) * side, seen_.depth.height()); ++y)
      for (int x = column * side; x < std::min((column + 1) * side, seen_.depth.width()); ++x)
        add(seen_.depth.at(x, y), static_cast<std::size_t>(y * seen_.depth.width() + x), result);
    return result;
  }

 private:
  void add(float depth_m, std::size_t pixel, Cell& cell) const {
    ++cell.pixels;
    const float fitted = seen_.plane_slope ? (*seen_.plane_slope)[pixel] : 0.f;
    const float slope = fitted > 0.f ? fitted : config_.unknown_slope;
    if (depth_m <= 0.f || slope < config_.least_slope) {
      ++cell.holes;
      return;
    }
    const float kept_m = std::max(margin_m_ / slope, config_.sigmas * (*seen_.sigma_m)[pixel]);
    cell.free_m = std::min(cell.free_m, depth_m - kept_m);
  }

  const Observation& seen_;
  const FreeSpaceConfig& config_;
  float margin_m_;
};

/// Of the cell and those around it.
float free_around(const Image<Cell>& cells, int column, int row, float most_holes) {
  Cell all;
  for (int y = std::max(row - 1, 0); y <= std::min(row + 1, cells.height() - 1); ++y)
    for (int x = std::max(column - 1, 0); x <= std::min(column + 1, cells.width() - 1); ++x)
      all.add(cells.at(x, y));
  const float allowed = most_holes * static_cast<float>(all.pixels);
  return static_cast<float>(all.holes) > allowed ? 0.f : std::max(all.free_m, 0.f);
}

}  // namespace

Image<float> free_depth(const VoxelMapConfig& map, const Observation& observation,
                        const FreeSpaceConfig& config) {
  OVIMAP_ASSERT(observation.sigma_m != nullptr);
  const int width = observation.depth.width(), height = observation.depth.height(),
            side = config.guard_px;
  const CellMaker maker(map, observation, config);
  Image<Cell> cells((width + side - 1) / side, (height + side - 1) / side);
  parallel_for(static_cast<std::size_t>(cells.height()), kCellRowsPerTask, [&](std::size_t row) {
    for (int x = 0; x < cells.width(); ++x)
      cells.at(x, static_cast<int>(row)) = maker.cell(x, static_cast<int>(row));
  });
  Image<float> result(width, height);
  parallel_for(static_cast<std::size_t>(cells.height()), kCellRowsPerTask, [&](std::size_t i) {
    const int row = static_cast<int>(i), end = std::min((row + 1) * side, height);
    for (int x = 0; x < cells.width(); ++x)
      std::fill_n(result.row(row * side) + x * side, std::min(side, width - x * side),
                  free_around(cells, x, row, config.holes));
    for (int y = row * side + 1; y < end; ++y)
      std::copy_n(result.row(row * side), width, result.row(y));
  });
  return result;
}

}  // namespace ovimap
