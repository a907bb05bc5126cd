// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "ovimap/image/image.h"
#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/map/rays/observed_space.h"

namespace ovimap {

class ConfigFields;

struct OccupancyConfig {
  float cell_m = 0.05f;     ///< edge of a cell
  int min_points = 3;       ///< surface points that make a cell an obstacle
  float free_share = 0.5f;  ///< of a column's cells that must be seen to be free, and none occupied
  float floor_share = 0.2f;  ///< of the largest level surface: the lowest such is the floor
  ObservedSpaceConfig space;
};
void list_fields(OccupancyConfig& config, ConfigFields& fields);

enum class CellState : std::uint8_t { kUnknown, kFree, kOccupied };

/// A map as cells in the grid frame: the world turned so that z is up (not at all where it is
/// already). Cells lie x fastest, then y, then z.
struct OccupancyGrid {
  Eigen::Matrix3f grid_from_world = Eigen::Matrix3f::Identity();
  float cell_m = 0;
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();  ///< lowest corner, grid frame, metres
  float floor_m = 0;                                 ///< height of the floor, grid frame
  std::vector<CellState> cells;

  /// Of a cell in `cells`.
  std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(size.x()) *
               (static_cast<std::size_t>(y) +
                static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(z));
  }
  CellState at(int x, int y, int z) const { return cells[index(x, y, z)]; }
  CellState& at(int x, int y, int z) { return cells[index(x, y, z)]; }
};

/// Occupied: surface of the map. Free: a camera of the frame log looked through it. Throws Error
/// when the map has no surface, when a cell is smaller than a voxel, or when there are more than
/// 2^28 cells.
OccupancyGrid make_occupancy_grid(const MapDocument& document, const OccupancyConfig& config = {});
/// The same with the map's mesh, where it is made already.
OccupancyGrid make_occupancy_grid(const MapDocument& document, const Mesh& mesh,
                                  const OccupancyConfig& config = {});

/// What a slice's picture holds, as map_server has it.
inline constexpr std::uint8_t kOccupiedLevel = 0, kFreeLevel = 254, kUnknownLevel = 205;

/// What a planner in the plane needs, row 0 at the largest y.
struct GridSlice {
  Image<std::uint8_t> occupancy;  ///< kOccupiedLevel, kFreeLevel or kUnknownLevel
  Image<float> distance_m;        ///< to the nearest obstacle; infinite where there is none
  Eigen::Vector2f origin = Eigen::Vector2f::Zero();  ///< lower left corner, grid frame, metres
  float cell_m = 0;
  float low_m = 0, high_m = 0;  ///< heights above the floor that it speaks of
};

/// The cells between two heights above the floor, seen from above: what a body that reaches from
/// one to the other can run into. Distances are within the plane.
GridSlice band_of(const OccupancyGrid& grid, float low_m, float high_m,
                  const OccupancyConfig& config);

/// Number of the layer of cells at a height above the floor; it may lie outside the grid.
int layer_at(const OccupancyGrid& grid, float height_m);

/// The middle of a cell of a picture whose lower left corner lies at `origin`, row 0 at the largest
/// y; grid frame, metres.
Eigen::Vector2f middle_of_cell(const Eigen::Vector2f& origin, float cell_m, int height, int x,
                               int row);

/// The layers of cells at some heights above the floor. Distances are in space, to obstacles of the
/// whole grid, floor and ceiling among them. Throws Error for a height outside the grid.
std::vector<GridSlice> layers_of(const OccupancyGrid& grid, const std::vector<float>& heights_m);

}  // namespace ovimap
