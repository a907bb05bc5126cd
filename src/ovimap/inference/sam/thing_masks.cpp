// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/thing_masks.h"

#include <algorithm>
#include <utility>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

// As tools/models/finder_network.py has them.
constexpr int kGridPxPerCell = 2;
constexpr float kPlaceUnit_gridPx = 32;  ///< of which the terms of place are multiples
enum PlaceTerm { kOne, kX, kY, kXX, kYY };
constexpr float kOutside = -20;  ///< a logit of what the image does not fill

using Images =
    Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

}  // namespace

ThingMasks::ThingMasks(FinderMaps maps, int grid_size) : maps_(std::move(maps)) {
  if (empty()) return;
  if (maps_.whole_columns * kGridPxPerCell != grid_size)
    throw Error(concat("the finder's masks are on a grid of ", maps_.whole_columns * kGridPxPerCell,
                       ", the decoder's on one of ", grid_size,
                       "; take the finder that belongs to this model"));
}

float ThingMasks::kernel(int term, const Eigen::Vector2i& cell) const {
  return maps_
      .kernels[static_cast<std::size_t>((term * maps_.rows + cell.y()) * maps_.columns + cell.x())];
}

MaskProposals ThingMasks::mask_at(const Eigen::Vector2i& cell, const LogitGrid& grid) const {
  const int rows = kGridPxPerCell * maps_.rows, columns = kGridPxPerCell * maps_.columns;
  const auto count = static_cast<int>(maps_.basis.size()) / (rows * columns);
  Eigen::VectorXf weights(count);
  for (int term = 0; term < count; ++term) weights[term] = kernel(term, cell);
  const Eigen::RowVectorXf sums =
      weights.transpose() * Images(maps_.basis.data(), count, rows * columns);
  const auto place = [&](PlaceTerm term) { return kernel(count + term, cell); };
  const auto away = [](int at, int of_cell) {
    const float middle = (static_cast<float>(of_cell) + 0.5f) * kGridPxPerCell - 0.5f;
    return (static_cast<float>(at) - middle) / kPlaceUnit_gridPx;
  };
  MaskProposals found{1, grid.size, {}, {}};
  found.logits.assign(static_cast<std::size_t>(grid.size * grid.size), kOutside);
  for (int y = 0; y < std::min(rows, grid.height); ++y) {
    const float v = away(y, cell.y());
    const float of_row = place(kOne) + v * (place(kY) + v * place(kYY));
    for (int x = 0; x < std::min(columns, grid.width); ++x) {
      const float u = away(x, cell.x());
      found.logits[static_cast<std::size_t>(y * grid.size + x)] =
          sums[y * columns + x] + of_row + u * (place(kX) + u * place(kXX));
    }
  }
  found.predicted_iou.push_back(logistic(kernel(count + FinderMaps::kPlaceTerms, cell)));
  return found;
}

}  // namespace ovimap
