// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "ovimap/pipeline/grids/occupancy_grid.h"

namespace ovimap {

/// Where the middle of a round robot can be: free cells of a slice whose nearest obstacle is no
/// nearer than its radius. Cells are addressed by x and y of the slice's picture.
class PassableCells {
 public:
  PassableCells(const GridSlice& slice, float radius_m);

  int width() const { return passable_.width(); }
  int height() const { return passable_.height(); }
  bool at(const Eigen::Vector2i& cell) const {
    return passable_.contains(cell.x(), cell.y()) && passable_.at(cell.x(), cell.y()) != 0;
  }
  /// Its middle, grid frame, metres.
  Eigen::Vector2f place_of(const Eigen::Vector2i& cell) const;
  /// The passable cell nearest to a place, at most `reach_m` away.
  std::optional<Eigen::Vector2i> nearest(const Eigen::Vector2f& place, float reach_m) const;
  /// A cell of the largest connected part; nothing where no cell is passable.
  std::optional<Eigen::Vector2i> in_largest_part() const;
  float cell_m() const { return cell_m_; }

 private:
  Image<std::uint8_t> passable_;
  Eigen::Vector2f origin_;
  float cell_m_;
};

/// Shortest ways from one cell to all others, over passable cells and their diagonals (Dijkstra).
class GroundWays {
 public:
  GroundWays(const PassableCells& cells, const Eigen::Vector2i& from);

  /// Infinite where no way leads.
  float length_m(const Eigen::Vector2i& cell) const { return length_m_.at(cell.x(), cell.y()); }
  bool reaches(const Eigen::Vector2i& cell) const {
    return length_m(cell) < std::numeric_limits<float>::infinity();
  }
  /// From the start to a cell that it reaches, both included: corners of the way, grid frame,
  /// metres. Straight wherever passable cells allow it.
  std::vector<Eigen::Vector2f> way_to(const Eigen::Vector2i& cell) const;

 private:
  const PassableCells& cells_;
  Image<float> length_m_;
  Image<std::uint8_t> came_by_;  ///< number of the step that led there
};

}  // namespace ovimap
