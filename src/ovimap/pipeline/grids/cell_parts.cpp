// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/grids/cell_parts.h"

#include <array>
#include <span>

namespace ovimap {

namespace {

using Cell = Eigen::Vector2i;

/// Those at sides, then those at corners.
std::span<const Cell> steps(Corners corners) {
  static const std::array<Cell, 8> all = {
      {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
  return std::span(all).first(corners == Corners::kConnected ? 8 : 4);
}

}  // namespace

std::vector<std::vector<Cell>> connected_parts(const Image<std::uint8_t>& cells, std::uint8_t value,
                                               Corners corners) {
  const std::span<const Cell> around = steps(corners);
  std::vector<std::vector<Cell>> parts;
  Image<std::uint8_t> seen(cells.width(), cells.height());
  for (int y = 0; y < cells.height(); ++y)
    for (int x = 0; x < cells.width(); ++x) {
      if (cells.at(x, y) != value || seen.at(x, y)) continue;
      std::vector<Cell> part = {{x, y}};
      seen.at(x, y) = 1;
      for (std::size_t i = 0; i < part.size(); ++i)
        for (const Cell& step : around) {
          const Cell next = part[i] + step;
          if (!cells.contains(next.x(), next.y()) || seen.at(next.x(), next.y()) ||
              cells.at(next.x(), next.y()) != value)
            continue;
          seen.at(next.x(), next.y()) = 1;
          part.push_back(next);
        }
      parts.push_back(std::move(part));
    }
  return parts;
}

}  // namespace ovimap
