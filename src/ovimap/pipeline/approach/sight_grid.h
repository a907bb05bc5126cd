// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ovimap/geometry/mesh.h"
#include "ovimap/pipeline/grids/occupancy_grid.h"

namespace ovimap {

/// A map's surface as fine cells of one bit each, for many rays between known points: what a ray
/// cast in voxels finds, at a hundredth of the memory. Grid frame, metres.
class SightGrid {
 public:
  SightGrid() = default;
  /// Cells of two voxels, so that surface leaves no gaps; larger where there would be more than
  /// 2^30 of them.
  SightGrid(const Mesh& mesh, const OccupancyGrid& grid, float voxel_size_m);

  /// Whether nothing lies between two points, but for what is as near to `to` as its own surface's
  /// cells are.
  bool clear(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const;

  float cell_m() const { return cell_m_; }

 private:
  bool filled(const Eigen::Vector3i& cell) const;
  void fill(const Eigen::Vector3f& point);
  std::size_t position(const Eigen::Vector3i& cell) const;
  bool contains(const Eigen::Vector3i& cell) const {
    return (cell.array() >= 0).all() && (cell.array() < size_.array()).all();
  }

  float cell_m_ = 1;
  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero();
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::vector<bool> cells_;
};

}  // namespace ovimap
