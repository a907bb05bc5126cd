// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/approach/sight_grid.h"

#include <limits>

namespace ovimap {

namespace {

/// A ray's walk from cell to cell (Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray
/// Tracing", 1987). In cells; distances are along the ray.
class CellWalk {
 public:
  CellWalk(const Eigen::Vector3f& start, const Eigen::Vector3f& direction)
      : cell_(start.array().floor().cast<int>()) {
    for (int k = 0; k < 3; ++k) {
      if (direction[k] == 0.f) continue;
      step_[k] = direction[k] > 0.f ? 1 : -1;
      const float border = static_cast<float>(cell_[k] + (step_[k] > 0));
      next_[k] = (border - start[k]) / direction[k];
      delta_[k] = 1.f / std::abs(direction[k]);
    }
  }

  const Eigen::Vector3i& cell() const { return cell_; }
  /// Goes on; returns how far along the ray the new cell begins.
  float advance() {
    Eigen::Index axis = 0;
    const float distance = next_.minCoeff(&axis);
    cell_[axis] += step_[axis];
    next_[axis] += delta_[axis];
    return distance;
  }

 private:
  static constexpr float kFar = std::numeric_limits<float>::max();
  Eigen::Vector3i cell_;
  Eigen::Vector3i step_ = Eigen::Vector3i::Zero();
  Eigen::Vector3f next_ = Eigen::Vector3f::Constant(kFar), delta_ = Eigen::Vector3f::Zero();
};

}  // namespace

SightGrid::SightGrid(const Mesh& mesh, const OccupancyGrid& grid, float voxel_size_m) {
  constexpr double kMostCells = 1 << 30;
  origin_ = grid.origin;
  const Eigen::Vector3d extent = grid.size.cast<double>() * double{grid.cell_m};
  cell_m_ = 2 * voxel_size_m;
  while ((extent / double{cell_m_}).array().ceil().prod() > kMostCells) cell_m_ *= 1.25f;
  size_ = (extent / double{cell_m_}).array().ceil().cast<int>();
  cells_.assign(static_cast<std::size_t>(size_.cast<std::int64_t>().prod()), false);
  for (const Eigen::Vector3f& vertex : mesh.vertices) fill(grid.grid_from_world * vertex);
  for (const auto& [a, b, c] : mesh.triangles)  // a triangle may reach into a cell by its inside
    fill(grid.grid_from_world * (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3.f);
}

std::size_t SightGrid::position(const Eigen::Vector3i& cell) const {
  const auto x = static_cast<std::size_t>(cell.x()), y = static_cast<std::size_t>(cell.y()),
             z = static_cast<std::size_t>(cell.z());
  return x + static_cast<std::size_t>(size_.x()) * (y + static_cast<std::size_t>(size_.y()) * z);
}

void SightGrid::fill(const Eigen::Vector3f& point) {
  const Eigen::Vector3i cell = ((point - origin_) / cell_m_).array().floor().cast<int>();
  if (contains(cell)) cells_[position(cell)] = true;
}

bool SightGrid::filled(const Eigen::Vector3i& cell) const {
  return contains(cell) && cells_[position(cell)];
}

bool SightGrid::clear(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const {
  constexpr float kOwnCells = 2.f;  // around `to`: those of the surface that it is on
  const Eigen::Vector3f start = (from - origin_) / cell_m_, way = (to - from) / cell_m_;
  const float length = way.norm() - kOwnCells;
  if (length <= 0.f) return true;
  CellWalk walk(start, way.normalized());
  for (float distance = 0.f; distance < length; distance = walk.advance())
    if (filled(walk.cell())) return false;
  return true;
}

}  // namespace ovimap
